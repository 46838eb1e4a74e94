//! `Clone`, `Copy` and `Debug` for types over an automaton, which asks nothing of the automaton itself, as deriving would.

/// Copies bit by bit.
macro_rules! copied {
    ($($of:ident),+) => {$(
        impl<A: Automaton> Clone for $of<A> {
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<A: Automaton> Copy for $of<A> {}
    )+};
}

/// Shows these fields, in this order; with `..`, not all there are.
macro_rules! shown {
    ($of:ident { $($field:ident),+ }) => {
        shown!($of { $($field),+ } finish);
    };
    ($of:ident { $($field:ident),+, .. }) => {
        shown!($of { $($field),+ } finish_non_exhaustive);
    };
    ($of:ident { $($field:ident),+ } $finish:ident) => {
        impl<A: Automaton> fmt::Debug for $of<A> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.debug_struct(stringify!($of))$(.field(stringify!($field), &self.$field))+.$finish()
            }
        }
    };
}

pub(crate) use {copied, shown};
