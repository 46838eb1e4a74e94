//! `#[derive(State)]`: a struct of numbers as the state of a hybrid automaton.
//!
//! Re-exported by `saltus` with its feature `derive`; see `saltus::State`.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Data, DeriveInput, Error, Field, Fields, Index, LitStr, Member, parse_macro_input, parse_quote};

/// Implements `saltus::State` for a struct whose fields are states: numbers, arrays, vectors, and structs
/// of the same kind.
///
/// Coordinates are counted field by field, in the order in which the fields stand. Each is named by its
/// field: `voltage`, `arm[2]`, `load.speed`. `#[unit("V")]` before a field is the unit of all its
/// coordinates; without it they have their own, if any. The struct is to be `Copy` and `Debug` as well.
///
/// A struct without fields, an enum and a union are refused as the program is compiled.
#[proc_macro_derive(State, attributes(unit))]
pub fn state(item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(item as DeriveInput);
    implemented(input).unwrap_or_else(Error::into_compile_error).into()
}

fn implemented(input: DeriveInput) -> Result<TokenStream, Error> {
    let DeriveInput { ident, mut generics, data, .. } = input;
    let Data::Struct(data) = data else {
        return Err(Error::new_spanned(
            ident,
            "State is derived for structs: give an automaton modes in place of variants",
        ));
    };
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
    let names = members.iter().zip(&types).map(|(member, ty)| {
        let name = member_name(member);
        quote!(::std::format!("{}{}", #name, <#ty as ::saltus::State>::within(&self.#member, i - first)).into())
    });
    let units = data.fields.iter().zip(members.iter().zip(&types)).map(unit).collect::<Result<Vec<_>, _>>()?;
    let values =
        members.iter().zip(&types).map(|(member, ty)| quote!(<#ty as ::saltus::State>::get(&self.#member, i - first)));
    let get = asked(&members, &types, values, quote!(f64::NAN));
    let name = asked(&members, &types, names, quote!(::std::format!("x{i}").into()));
    let unit = asked(&members, &types, units, quote!(""));
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

/// The answer about coordinate `i` of the field in which it lies, whose first coordinate is `first`; else `none`.
fn asked(
    members: &[Member],
    types: &[syn::Type],
    answers: impl IntoIterator<Item = TokenStream>,
    none: TokenStream,
) -> TokenStream {
    let answers = answers.into_iter();
    quote! {
        let mut first = 0;
        #({
            let len = <#types as ::saltus::State>::len(&self.#members);
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

/// The unit of a field, as it is said before it or asked of the field.
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
