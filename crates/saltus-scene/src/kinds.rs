//! Kinds of a table: what each is called, what it is, and which keys it takes, declared once.
//!
//! From the declaration come what a file may say, the check that refuses keys of another kind, its
//! message, and the description in the schema. A test holds docs/use/scenes.md to it.

/// Declares the kinds of a table. `none` is what the table is where no kind is named, with the keys
/// it takes then.
macro_rules! kinds {
    (
        $(#[$meta:meta])*
        enum $kind:ident of $table:ident by $by:literal, none $without:literal { $($free:ident),* } {
            $($variant:ident = $name:literal, $about:literal { $($key:ident),* })*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
        #[cfg_attr(test, derive(JsonSchema))]
        #[cfg_attr(test, schemars(inline))]
        enum $kind {
            $(
                #[doc = concat!($about, $(" `", stringify!($key), "`",)*)]
                #[serde(rename = $name)]
                $variant,
            )*
        }

        impl $kind {
            /// The keys that it takes.
            const fn keys(self) -> &'static [&'static str] {
                match self {
                    $(Self::$variant => &[$(stringify!($key)),*],)*
                }
            }

            /// What it is called in a message.
            const fn says(self) -> &'static str {
                match self {
                    $(Self::$variant => concat!($by, " = \"", $name, "\""),)*
                }
            }
        }

        impl $table {
            /// Refuses what is given but belongs to another kind.
            fn only(&self, kind: Option<$kind>) -> Result<(), Fault> {
                let given = [
                    $((stringify!($free), self.$free.as_ref().map(At::span)),)*
                    $($((stringify!($key), self.$key.as_ref().map(At::span)),)*)*
                ];
                let keys = kind.map_or(&[$(stringify!($free)),*][..], $kind::keys);
                crate::value::only(given, keys, kind.map_or($without, $kind::says))
            }
        }
    };
}

pub(crate) use kinds;
