//! `#[derive(State)]` and `#[derive(Lift)]`: a struct of numbers as the state of a hybrid
//! automaton.
//!
//! Re-exported by `saltus` with its feature `derive`; see `saltus::State` and `saltus::Lift`.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use syn::{
    Data, DataStruct, DeriveInput, Error, Field, Fields, GenericParam, Ident, Index, LitStr, Member, WherePredicate,
    parse_macro_input, parse_quote,
};

/// Implements `saltus::State` for a struct whose fields are states: numbers, arrays, vectors, and
/// structs of the same kind.
///
/// Coordinates are counted field by field, in the order in which the fields stand. Each is named by
/// its field: `voltage`, `arm[2]`, `load.speed`. `#[unit("V")]` before a field is the unit of all
/// its coordinates; without it they have their own, if any. The struct is to be `Clone` and `Debug`
/// as well.
///
/// A struct without fields, an enum and a union are refused as the program is compiled.
#[proc_macro_derive(State, attributes(unit))]
pub fn state(item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(item as DeriveInput);
    implemented(input).unwrap_or_else(Error::into_compile_error).into()
}

/// Implements `saltus::Lift` for a struct that derives `State` and whose one type parameter is the
/// type of its numbers, `struct Swing<D = f64> { angle: D, rates: [D; 2], load: Load<D> }`: over
/// another number it is the same struct.
///
/// A struct with no type parameter, or more than one, is refused as the program is compiled.
#[proc_macro_derive(Lift)]
pub fn lift(item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(item as DeriveInput);
    lifted(input).unwrap_or_else(Error::into_compile_error).into()
}

fn lifted(input: DeriveInput) -> Result<TokenStream, Error> {
    let DeriveInput { ident, mut generics, data, .. } = input;
    let (members, types) = parts(&structure(&ident, data)?.fields);
    if generics.type_params().count() != 1 {
        return Err(Error::new_spanned(
            &ident,
            format!("Lift needs the type of the numbers as the one type parameter: struct {ident}<D = f64>"),
        ));
    }
    let arguments = |number: TokenStream| {
        let arguments = generics.params.iter().map(move |parameter| match parameter {
            GenericParam::Type(_) => number.clone(),
            GenericParam::Const(constant) => constant.ident.to_token_stream(),
            GenericParam::Lifetime(lifetime) => lifetime.lifetime.to_token_stream(),
        });
        quote!(#ident<#(#arguments),*>)
    };
    let (number, other) = (arguments(quote!(f64)), arguments(quote!(Lifted)));
    let picked = members.iter().map(|member| quote!(::saltus::Lift::pick(&self.#member, &over.#member, i - first)));
    let pick = asked(&members, picked, quote!(<Lifted as ::core::convert::From<f64>>::from(f64::NAN)));
    let made: Vec<_> = (0..types.len()).map(|place| format_ident!("part_{place}")).collect();
    generics.params = generics.params.into_iter().filter(|p| !matches!(p, GenericParam::Type(_))).collect();
    let (impls, _, clause) = generics.split_for_impl();
    Ok(quote! {
        #[automatically_derived]
        impl #impls ::saltus::Lift for #number #clause {
            type Over<Lifted: ::saltus::Number> = #other;

            #[inline]
            fn lift<Lifted: ::saltus::Number>(&self, mut f: impl FnMut(usize) -> Lifted) -> #other {
                let mut first = 0;
                #(
                    let #made = ::saltus::Lift::lift(&self.#members, |i| f(first + i));
                    first += ::saltus::State::len(&self.#members);
                )*
                let _ = first;
                #ident { #(#members: #made),* }
            }
            #[inline]
            fn pick<Lifted: ::saltus::Number>(&self, over: &#other, i: usize) -> Lifted {
                #pick
            }
        }
    })
}

fn structure(ident: &Ident, data: Data) -> Result<DataStruct, Error> {
    let Data::Struct(data) = data else {
        let advice = "a state is a struct: give an automaton modes in place of variants";
        return Err(Error::new_spanned(ident, advice));
    };
    Ok(data)
}

fn implemented(input: DeriveInput) -> Result<TokenStream, Error> {
    let DeriveInput { ident, mut generics, data, .. } = input;
    let data = structure(&ident, data)?;
    let (members, types) = parts(&data.fields);
    if members.is_empty() {
        return Err(Error::new_spanned(
            ident,
            "a state has one coordinate at least: give the struct a field of type f64",
        ));
    }
    for parameter in generics.type_params_mut() {
        parameter.bounds.push(parse_quote!(::saltus::State));
    }
    if generics.type_params().next().is_some() {
        // A list or a struct of parameters is a state for some of them only.
        generics
            .make_where_clause()
            .predicates
            .extend(types.iter().map::<WherePredicate, _>(|ty| parse_quote!(#ty: ::saltus::State)));
    }
    let names = members.iter().zip(&types).map(|(member, ty)| {
        let name = member_name(member);
        quote!(::std::format!("{}{}", #name, <#ty as ::saltus::State>::within(&self.#member, i - first)).into())
    });
    let units = data.fields.iter().zip(members.iter().zip(&types)).map(unit).collect::<Result<Vec<_>, _>>()?;
    let values =
        members.iter().zip(&types).map(|(member, ty)| quote!(<#ty as ::saltus::State>::get(&self.#member, i - first)));
    let get = asked(&members, values, quote!(f64::NAN));
    let name = asked(&members, names, quote!(::std::format!("x{i}").into()));
    let unit = asked(&members, units, quote!(""));
    let made: Vec<_> = (0..members.len()).map(|place| format_ident!("part_{place}")).collect();
    let (impls, uses, clause) = generics.split_for_impl();
    Ok(quote! {
        #[automatically_derived]
        impl #impls ::saltus::State for #ident #uses #clause {
            #[inline]
            fn len(&self) -> usize {
                0 #(+ <#types as ::saltus::State>::len(&self.#members))*
            }
            #[inline]
            fn get(&self, i: usize) -> f64 {
                #get
            }
            #[inline]
            fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
                let mut first = 0;
                #(
                    let len = <#types as ::saltus::State>::len(&self.#members);
                    let #made = <#types as ::saltus::State>::with(&self.#members, |i| f(first + i));
                    first += len;
                )*
                let _ = first;
                Self { #(#members: #made),* }
            }
            fn name(&self, i: usize) -> ::std::borrow::Cow<'static, str> {
                #name
            }
            fn unit(&self, i: usize) -> &'static str {
                #unit
            }
            fn within(&self, i: usize) -> ::std::string::String {
                ::std::format!(".{}", ::saltus::State::name(self, i))
            }
        }
    })
}

/// The answer about coordinate `i` of the field in which it lies, whose first coordinate is
/// `first`; else `none`.
fn asked(members: &[Member], answers: impl IntoIterator<Item = TokenStream>, none: TokenStream) -> TokenStream {
    let answers = answers.into_iter();
    quote! {
        let mut first = 0;
        #({
            let len = ::saltus::State::len(&self.#members);
            if i < first + len {
                return #answers;
            }
            first += len;
        })*
        let _ = first;
        #none
    }
}

fn parts(fields: &Fields) -> (Vec<Member>, Vec<syn::Type>) {
    let member = |(place, field): (usize, &Field)| match &field.ident {
        Some(ident) => Member::Named(ident.clone()),
        None => Member::Unnamed(Index::from(place)),
    };
    (fields.iter().enumerate().map(member).collect(), fields.iter().map(|field| field.ty.clone()).collect())
}

/// The unit of a field, as its attribute states it or the field's type has it.
fn unit((field, (member, ty)): (&Field, (&Member, &syn::Type))) -> Result<TokenStream, Error> {
    let mut said = field.attrs.iter().filter(|attribute| attribute.path().is_ident("unit"));
    let Some(attribute) = said.next() else {
        return Ok(quote!(<#ty as ::saltus::State>::unit(&self.#member, i - first)));
    };
    if let Some(second) = said.next() {
        return Err(Error::new_spanned(second, "the unit of a field is said twice: say it once"));
    }
    let unit: LitStr =
        attribute.parse_args().map_err(|_| Error::new_spanned(attribute, "a unit is text: write #[unit(\"V\")]"))?;
    Ok(quote!(#unit))
}

fn member_name(member: &Member) -> String {
    match member {
        Member::Named(ident) => ident.to_string().trim_start_matches("r#").to_owned(),
        Member::Unnamed(index) => index.index.to_string(),
    }
}
