//! What a mode's coordinates may be: anything with a length, a way to read one coordinate and a way
//! to rebuild itself.

use std::borrow::Cow;
use std::fmt::Debug;

use nalgebra::SVector;

/// The continuous state x of a hybrid automaton: a list of real coordinates.
///
/// Implemented for `f64`, `[f64; N]`, [`SVector<f64, N>`]; for [`Coords`], whose dimension may
/// differ from mode to mode, and [`Vector`](crate::Vector), which has any; and, with the feature
/// `derive`, by `#[derive(State)]` for a struct of these, whose fields then name its coordinates in
/// flows, tables and errors.
///
/// ```
/// use saltus::State;
/// let x = [1.0, 2.0];
/// assert_eq!(x.with(|i| 10.0 * x.get(i)), [10.0, 20.0]);
/// ```
#[diagnostic::on_unimplemented(
    note = "with the feature `derive` of saltus, a struct of numbers is a state by `#[derive(State)]`"
)]
pub trait State: Clone + Debug {
    /// How many coordinates there are.
    fn len(&self) -> usize;

    /// Coordinate `i`, for `i < len()`.
    fn get(&self, i: usize) -> f64;

    /// A state of the same shape whose coordinate `i` is `f(i)`.
    #[must_use]
    fn with(&self, f: impl FnMut(usize) -> f64) -> Self;

    /// The name of coordinate `i`, for tables and errors: `x0`, `x1`, … unless the state names it.
    fn name(&self, i: usize) -> Cow<'static, str> {
        format!("x{i}").into()
    }

    /// The unit of coordinate `i`, for tables and pictures: `V`, `1/min`; empty unless the state
    /// names one. With the feature `derive`, `#[unit("V")]` before a field says it.
    fn unit(&self, i: usize) -> &'static str {
        let _ = i;
        ""
    }

    /// What follows the name of a field of this type in the name of its coordinate `i`: nothing for
    /// a number, `[i]` for a list.
    #[doc(hidden)]
    fn within(&self, i: usize) -> String {
        format!("[{i}]")
    }

    /// How many bytes it holds elsewhere, as coordinates on the heap; a recording counts them.
    #[inline]
    fn heap(&self) -> usize {
        0
    }

    /// Whether there are no coordinates at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether every coordinate is a finite number.
    fn is_finite(&self) -> bool {
        (0..self.len()).all(|i| self.get(i).is_finite())
    }
}

impl State for f64 {
    fn within(&self, _: usize) -> String {
        String::new()
    }
    #[inline]
    fn len(&self) -> usize {
        1
    }
    #[inline]
    fn get(&self, _: usize) -> f64 {
        *self
    }
    #[inline(always)]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }
}

impl<const N: usize> State for [f64; N] {
    #[inline]
    fn len(&self) -> usize {
        N
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        self[i]
    }
    // A plain loop, whose body is compiled in: for each `f` `std::array::from_fn` would compile
    // several functions, and an iterator three times the code.
    #[inline(always)]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        let (mut of, mut i) = ([0.0; N], 0);
        while i < N {
            of[i] = f(i);
            i += 1;
        }
        of
    }
}

impl<const N: usize> State for SVector<f64, N> {
    #[inline]
    fn len(&self) -> usize {
        N
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        self[i]
    }
    #[inline(always)]
    fn with(&self, f: impl FnMut(usize) -> f64) -> Self {
        [0.0; N].with(f).into()
    }
}

/// Up to `CAP` coordinates, for automata whose modes differ in dimension: a hopper has three in
/// flight and two in stance.
///
/// ```
/// use saltus::{Coords, State};
/// let flight: Coords<4> = [0.0, 1.0, 0.0, -0.5].into();
/// let stance: Coords<4> = [1.0, -0.5].into();
/// assert_eq!((flight.len(), stance.len()), (4, 2));
/// ```
///
/// A list longer than `CAP` does not compile; one that is read (feature `serde`) is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coords<const CAP: usize> {
    values: [f64; CAP],
    len: usize,
}

impl<const CAP: usize, const N: usize> From<[f64; N]> for Coords<CAP> {
    fn from(list: [f64; N]) -> Self {
        const { assert!(N <= CAP, "more coordinates than CAP") };
        let mut values = [0.0; CAP];
        values[..N].copy_from_slice(&list);
        Self { values, len: N }
    }
}

/// As many coordinates as the list has; [`TooMany`] where there is no room for them.
///
/// ```
/// use saltus::{Coords, State};
/// let read = vec![1.0, -0.5];
/// assert_eq!(Coords::<4>::try_from(&read[..]).unwrap().len(), 2);
/// assert!(Coords::<1>::try_from(&read[..]).is_err());
/// ```
impl<const CAP: usize> TryFrom<&[f64]> for Coords<CAP> {
    type Error = TooMany;
    fn try_from(list: &[f64]) -> Result<Self, TooMany> {
        let (mut values, len) = ([0.0; CAP], list.len());
        values.get_mut(..len).ok_or(TooMany { coordinates: len, room: CAP })?.copy_from_slice(list);
        Ok(Self { values, len })
    }
}

/// A list has more coordinates than there is room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TooMany {
    /// How many it has.
    pub coordinates: usize,
    /// For how many there is room.
    pub room: usize,
}

impl std::fmt::Display for TooMany {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} coordinates are more than there is room for, {}", self.coordinates, self.room)
    }
}

impl std::error::Error for TooMany {}

/// Written as the list of the coordinates there are.
#[cfg(feature = "serde")]
impl<const CAP: usize> serde::Serialize for Coords<CAP> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.values.iter().take(self.len))
    }
}

/// Read from a list of at most `CAP` numbers.
#[cfg(feature = "serde")]
impl<'de, const CAP: usize> serde::Deserialize<'de> for Coords<CAP> {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct List<const CAP: usize>;

        impl<'de, const CAP: usize> serde::de::Visitor<'de> for List<CAP> {
            type Value = Coords<CAP>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "a list of at most {CAP} coordinates")
            }

            fn visit_seq<L: serde::de::SeqAccess<'de>>(self, mut list: L) -> Result<Coords<CAP>, L::Error> {
                let mut coords = Coords { values: [0.0; CAP], len: 0 };
                while let Some(value) = list.next_element()? {
                    let Some(place) = coords.values.get_mut(coords.len) else {
                        return Err(serde::de::Error::invalid_length(coords.len + 1, &self));
                    };
                    *place = value;
                    coords.len += 1;
                }
                Ok(coords)
            }
        }

        deserializer.deserialize_seq(List)
    }
}

/// The coordinates as a slice.
impl<const CAP: usize> std::ops::Deref for Coords<CAP> {
    type Target = [f64];
    #[inline]
    fn deref(&self) -> &[f64] {
        &self.values[..self.len]
    }
}

impl<const CAP: usize> State for Coords<CAP> {
    #[inline]
    fn len(&self) -> usize {
        self.len
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        self.values[i]
    }
    #[inline]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        let (mut values, mut i) = ([0.0; CAP], 0);
        while i < self.len {
            values[i] = f(i);
            i += 1;
        }
        Self { values, len: self.len }
    }
}
