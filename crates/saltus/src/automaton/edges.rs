//! The edges out of a mode.

/// The edges out of a mode, in order of priority: any number of them, without allocation.
///
/// A few are given as an array or collected; many are a list that the model keeps, or follow from
/// their index. None is ever left out: an array of more than [`Edges::INLINE`] does not compile,
/// and a run fails in a mode that collects more.
///
/// ```
/// use saltus::Edges;
/// let edges = Edges::from(['a', 'b']);
/// assert_eq!(edges.iter().collect::<String>(), "ab");
/// assert_eq!(Edges::<char>::none().len(), 0);
/// let marks: Vec<u32> = (0..100).collect();
/// assert_eq!(Edges::kept(&marks).iter().sum::<u32>(), 4950);
/// assert_eq!(Edges::indexed(1_000_000, |i| i).iter().sum::<usize>(), 499_999_500_000);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Edges<'a, E> {
    len: usize,
    list: List<'a, E>,
}

#[derive(Clone, Copy, Debug)]
enum List<'a, E> {
    Inline([Option<E>; Edges::<()>::INLINE]),
    Kept(&'a [E]),
    Indexed(fn(usize) -> E),
}

impl<'a, E: Copy> Edges<'a, E> {
    /// How many edges an array may have, or may be collected.
    pub const INLINE: usize = 16;

    /// No edges: the mode is never left.
    #[must_use]
    #[inline]
    pub const fn none() -> Self {
        Self { len: 0, list: List::Inline([None; Edges::<()>::INLINE]) }
    }

    /// Edges that the model keeps.
    #[must_use]
    #[inline]
    pub const fn kept(edges: &'a [E]) -> Self {
        Self { len: edges.len(), list: List::Kept(edges) }
    }

    /// The edges `edge(0)`, `edge(1)`, … `edge(count - 1)`.
    #[must_use]
    #[inline]
    pub const fn indexed(count: usize, edge: fn(usize) -> E) -> Self {
        Self { len: count, list: List::Indexed(edge) }
    }

    /// How many edges there are.
    #[must_use]
    #[inline]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Whether the mode is never left.
    #[must_use]
    #[inline]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The edge, if there is just one.
    #[inline]
    pub(crate) fn only(&self) -> Option<E> {
        if self.len == 1 { self.get(0) } else { None }
    }

    /// Whether more were collected than there is room for: why no run goes on with them.
    #[inline]
    pub(crate) fn flaw(&self) -> Option<String> {
        let overflows = self.len > Edges::<()>::INLINE && matches!(self.list, List::Inline(_));
        if overflows { Some(overflow(self.len)) } else { None }
    }

    /// The edges in order.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = E> {
        (0..self.len).filter_map(|i| self.get(i))
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Option<E> {
        match &self.list {
            List::Inline(list) => *list.get(i)?,
            List::Kept(list) => list.get(i).copied(),
            List::Indexed(edge) => Some(edge(i)),
        }
    }
}

/// By value, so that the edges of a mode need not lie in memory for it.
#[cold]
fn overflow(len: usize) -> String {
    let most = Edges::<()>::INLINE;
    format!(
        "{len} edges were collected for a mode, and there is room for {most}: keep a list and lend it by Edges::kept, or name them by Edges::indexed"
    )
}

/// An array of at most [`Edges::INLINE`]; a longer one does not compile.
///
/// ```compile_fail
/// let edges = saltus::Edges::from([0; 17]);
/// ```
impl<E: Copy, const N: usize> From<[E; N]> for Edges<'_, E> {
    #[inline]
    fn from(edges: [E; N]) -> Self {
        const { assert!(N <= Edges::<()>::INLINE, "too many edges for an array: use Edges::kept or Edges::indexed") };
        let mut list = [None; Edges::<()>::INLINE];
        for (place, edge) in list.iter_mut().zip(edges) {
            *place = Some(edge);
        }
        Self { len: N, list: List::Inline(list) }
    }
}

/// At most [`Edges::INLINE`]: a run fails where more are collected.
impl<E: Copy> FromIterator<E> for Edges<'_, E> {
    #[inline]
    fn from_iter<I: IntoIterator<Item = E>>(edges: I) -> Self {
        let (mut list, mut len) = ([None; Edges::<()>::INLINE], 0);
        for edge in edges {
            if let Some(place) = list.get_mut(len) {
                *place = Some(edge);
            }
            len += 1;
        }
        Self { len, list: List::Inline(list) }
    }
}
