//! `#[derive(State)]`: a struct of numbers as the state of a hybrid automaton.
//!
//! Re-exported by `saltus` with its feature `derive`; see `saltus::State`.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Data, DeriveInput, Error, Fields, Index, Member, parse_macro_input, parse_quote};

/// Implements `saltus::State` for a struct whose fields are states: numbers, arrays, vectors, and structs
/// of the same kind.
///
/// Coordinates are counted field by field, in the order in which the fields stand. Each is named by its
/// field: `voltage`, `arm[2]`, `load.speed`. The struct is to be `Copy` and `Debug` as well.
///
/// A struct without fields, an enum and a union are refused as the program is compiled.
#[proc_macro_derive(State)]
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
    let names: Vec<String> = members.iter().map(member_name).collect();
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
                let mut first = 0;
                #({
                    let len = <#types as ::saltus::State>::len(&self.#members);
                    if i < first + len {
                        return <#types as ::saltus::State>::get(&self.#members, i - first);
                    }
                    first += len;
                })*
                let _ = first;
                f64::NAN
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
                let mut first = 0;
                #({
                    let len = <#types as ::saltus::State>::len(&self.#members);
                    if i < first + len {
                        let within = <#types as ::saltus::State>::within(&self.#members, i - first);
                        return ::std::format!("{}{}", #names, within).into();
                    }
                    first += len;
                })*
                let _ = first;
                ::std::format!("x{i}").into()
            }
            fn within(&self, i: usize) -> ::std::string::String {
                ::std::format!(".{}", ::saltus::State::name(self, i))
            }
        }
    })
}

fn parts(fields: &Fields) -> (Vec<Member>, Vec<syn::Type>) {
    let member = |(place, field): (usize, &syn::Field)| match &field.ident {
        Some(ident) => Member::Named(ident.clone()),
        None => Member::Unnamed(Index::from(place)),
    };
    (fields.iter().enumerate().map(member).collect(), fields.iter().map(|field| field.ty.clone()).collect())
}

fn member_name(member: &Member) -> String {
    match member {
        Member::Named(ident) => ident.to_string().trim_start_matches("r#").to_owned(),
        Member::Unnamed(index) => index.index.to_string(),
    }
}
