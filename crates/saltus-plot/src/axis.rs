//! An axis: its range, its ticks at 1, 2 or 5 times a power of ten, its numbers.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, KeyPointWeight, NoDefaultFormatting, Ranged, ValueFormatter};

use crate::curve::Affine;
use crate::unit::superscript;

/// An axis of more powers of ten than this is labelled by their exponents.
pub(crate) const MANY_DECADES: f64 = 5.0;

/// An axis of powers of ten has at least so many numbers: fewer do not show that it is one.
const FEWEST: usize = 3;
/// The number of parts into which it is divided where 1, 2 and 5 times a power are fewer.
const PARTS: f64 = 8.0;

/// An axis in the units it is labelled with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Axis {
    low: f64,
    high: f64,
    /// Ticks lie in this part only.
    ticked: (f64, f64),
    step: f64,
    /// Whether the values are powers of ten.
    decades: bool,
    /// The part of powers of ten so near to each other that multiples of it stand between them.
    part: Option<f64>,
    /// The value at which all lesser ones stand.
    least: Option<f64>,
}

impl Axis {
    /// An axis from `low` to `high` with at most `most` ticks, all inside `ticked`.
    pub(crate) fn new(low: f64, high: f64, ticked: (f64, f64), most: usize) -> Self {
        let span = ticked.1 - ticked.0;
        Self { low, high, ticked, step: nice(span / most.max(1) as f64), decades: false, part: None, least: None }
    }

    /// An axis without ticks.
    pub(crate) const fn bare(low: f64, high: f64) -> Self {
        Self { low, high, ticked: (1.0, 0.0), step: 1.0, decades: false, part: None, least: None }
    }

    /// An axis of powers of ten from 10^`low` to 10^`high`.
    pub(crate) fn decades(low: f64, high: f64) -> Self {
        let step = ((high - low) / 8.0).ceil().max(1.0);
        let even = Self { low, high, ticked: (low, high), step, decades: true, part: None, least: None };
        let part = (even.regular().len() < FEWEST).then(|| nice((10f64.powf(high) - 10f64.powf(low)) / PARTS));
        Self { part, ..even }
    }

    /// This axis with a tick at `least` for all values up to it.
    pub(crate) const fn at_least(mut self, least: Option<f64>) -> Self {
        self.least = least;
        self
    }

    /// This axis with ticks at whole numbers only.
    pub(crate) const fn whole(mut self) -> Self {
        self.step = self.step.max(1.0);
        self
    }

    /// This axis with ticks so far apart that their labels, `width` px each, keep `gap` px between
    /// them on `length` px.
    pub(crate) fn thinned(mut self, length: f64, gap: f64, width: impl Fn(&str) -> f64) -> Self {
        for _ in 0..12 {
            let apart = self.step / (self.high - self.low) * length;
            let widest = self.ticks().iter().map(|&tick| width(&self.text(tick))).fold(0.0, f64::max);
            if widest + gap <= apart || self.ticks().len() <= 2 {
                break;
            }
            self.step = nice(self.step * 1.01);
        }
        self
    }

    pub(crate) fn ends(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    pub(crate) fn ticks(&self) -> Vec<f64> {
        let Some(least) = self.least else { return self.regular() };
        // Its words are longer than others: the next tick keeps its distance.
        let others = self.regular().into_iter().filter(|tick| tick - least > 0.99 * self.step);
        std::iter::once(least).chain(others).collect()
    }

    fn regular(&self) -> Vec<f64> {
        let slack = 1e-9;
        if let Some(part) = self.part {
            let [from, to] = [self.low, self.high].map(|end| 10f64.powf(end) / part);
            let count = (to.floor() - from.ceil()).max(0.0) as usize;
            return (0..=count).map(|n| ((from.ceil() + n as f64) * part).log10()).collect();
        }
        let first = (self.ticked.0 / self.step - slack).ceil();
        let last = (self.ticked.1 / self.step + slack).floor();
        let mut ticks = Vec::new();
        if self.decades && self.high - self.low < 3.5 {
            let (from, to) = (self.low.floor(), self.high);
            let within = |t: &f64| (self.low..=self.high).contains(t);
            let mut decade = from;
            while decade <= to {
                ticks.extend([1.0_f64, 2.0, 5.0].map(|times| decade + times.log10()).iter().copied().filter(within));
                decade += 1.0;
            }
            return ticks;
        }
        let mut index = first;
        // The bound only matters when the step is too small to move a huge index.
        while index <= last && ticks.len() < 64 {
            ticks.push(index * self.step);
            index += 1.0;
        }
        ticks
    }

    /// The number as it is written beside its tick: no more decimals than the step needs.
    pub(crate) fn text(&self, value: f64) -> String {
        let text = self.plain(value);
        if self.least == Some(value) { format!("≤ {text}") } else { text }
    }

    fn plain(&self, value: f64) -> String {
        if self.decades && self.high - self.low > MANY_DECADES {
            return format!("10{}", superscript(value.round() as i32));
        }
        if let Some(part) = self.part {
            let decimals = (-(part.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize;
            return typeset(&format!("{:.decimals$}", 10f64.powf(value)));
        }
        if self.decades {
            let decimals = (-value.floor()).clamp(0.0, 12.0) as usize;
            return typeset(&format!("{:.decimals$}", 10f64.powf(value)));
        }
        let decimals = (-(self.step.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize;
        let plain = format!("{value:.decimals$}");
        typeset(&plain)
    }

    /// The map of this axis onto px from `from` to `to`.
    pub(crate) fn onto(&self, from: f64, to: f64) -> Affine {
        Affine { origin: from, scale: (to - from) / (self.high - self.low), zero: self.low }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        // `as` saturates, so that a wild value ends up far outside rather than somewhere else.
        self.onto(f64::from(limit.0), f64::from(limit.1)).at(*value).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // plotters asks twice, for a fine grid and a coarse one; the coarse one is enough.
        match hint.weight() {
            KeyPointWeight::Bold => self.ticks(),
            KeyPointWeight::Any => Vec::new(),
        }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(value: &f64) -> String {
        typeset(&format!("{value}"))
    }

    fn format_ext(&self, value: &f64) -> String {
        self.text(*value)
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `least`.
pub(crate) fn nice(least: f64) -> f64 {
    if !(least.is_finite() && least > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(least.log10().floor() as i32);
    let times = [1.0, 2.0, 5.0].into_iter().find(|times| times * power >= least * (1.0 - 1e-9)).unwrap_or(10.0);
    times * power
}

/// Values that differ by no more than this part of the greatest are one: steps of the usual
/// tolerance leave as much between what is the same.
const SAME: f64 = 1e-9;

/// The reach of values, opened to both sides where they are all the same.
pub(crate) fn opened((low, high): (f64, f64)) -> (f64, f64) {
    let least = SAME * low.abs().max(high.abs());
    if high - low > least {
        (low, high)
    } else if high == 0.0 {
        (-0.5, 0.5)
    } else {
        (low - 0.5 * high.abs(), high + 0.5 * high.abs())
    }
}

/// A number with a true minus sign, and thin spaces between thousands from five digits on.
pub(crate) fn typeset(plain: &str) -> String {
    let (negative, digits) = match plain.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, plain),
    };
    let whole = digits.split('.').next().unwrap_or(digits);
    let zero = digits.chars().all(|c| c == '0' || c == '.');
    let mut text = String::new();
    if negative && !zero {
        text.push('\u{2212}');
    }
    for (i, c) in whole.chars().enumerate() {
        if i > 0 && whole.len() > 4 && (whole.len() - i) % 3 == 0 {
            text.push('\u{2009}');
        }
        text.push(c);
    }
    text.push_str(&digits[whole.len()..]);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_five() {
        for (least, step) in [(0.9, 1.0), (1.0, 1.0), (1.1, 2.0), (2.5, 5.0), (5.1, 10.0), (0.03, 0.05)] {
            assert!((nice(least) / step - 1.0).abs() < 1e-12, "{least}");
        }
        assert_eq!(nice(0.0), 1.0);
    }

    #[test]
    fn ticks_are_multiples_inside_the_range() {
        let axis = Axis::new(-0.02, 1.13, (0.0, 1.13), 8);
        let texts: Vec<_> = axis.ticks().iter().map(|&t| axis.text(t)).collect();
        assert_eq!(texts, ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    }

    #[test]
    fn a_late_clock_keeps_its_ticks() {
        let axis = Axis::new(1e6, 1e6 + 1.0, (1e6, 1e6 + 1.0), 5);
        let texts: Vec<_> = axis.ticks().iter().map(|&t| axis.text(t)).collect();
        assert_eq!(texts.len(), 6);
        assert_eq!(texts[1], "1\u{2009}000\u{2009}000.2");
    }

    #[test]
    fn many_decades_are_labelled_by_their_exponents() {
        let axis = Axis::decades(-12.0, -1.0);
        let texts: Vec<_> = axis.ticks().iter().map(|&t| axis.text(t)).collect();
        assert_eq!(texts, ["10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²"]);
        assert_eq!(Axis::decades(-2.0, 1.0).text(-1.0), "0.1");
    }

    /// However short a part of a power of ten an axis is, it has numbers, each another.
    #[test]
    fn powers_of_ten_that_are_near_have_numbers_too() {
        for from in 0..97 {
            for width in [0.06, 0.1, 0.3, 0.61, 1.0, 2.0, 3.4, 3.6, 7.0] {
                let low = -3.0 + f64::from(from) / 16.0;
                let axis = Axis::decades(low, low + width);
                let ticks = axis.ticks();
                let mut texts: Vec<_> = ticks.iter().map(|&t| axis.text(t)).collect();
                assert!((FEWEST..=11).contains(&ticks.len()), "{low} + {width}: {texts:?}");
                assert!(ticks.iter().all(|t| (low..=low + width).contains(t)), "{low} + {width}: {texts:?}");
                texts.dedup();
                assert_eq!(texts.len(), ticks.len(), "{low} + {width}: {texts:?}");
            }
        }
        let texts = |axis: Axis| axis.ticks().iter().map(|&t| axis.text(t)).collect::<Vec<_>>();
        assert_eq!(texts(Axis::decades(24f64.log10(), 47f64.log10())), ["25", "30", "35", "40", "45"]);
    }

    #[test]
    fn the_least_is_marked_as_such_and_the_next_tick_keeps_its_distance() {
        let axis = Axis::decades(-15.2, -1.0).at_least(Some(-15.0));
        let texts: Vec<_> = axis.ticks().iter().map(|&t| axis.text(t)).collect();
        assert_eq!(texts, ["≤ 10⁻¹⁵", "10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²"]);
    }

    #[test]
    fn minus_is_a_minus_and_zero_has_none() {
        assert_eq!(typeset("-0.5"), "\u{2212}0.5");
        assert_eq!(typeset("-0.0"), "0.0");
        assert_eq!(typeset("12345"), "12\u{2009}345");
        assert_eq!(typeset("1234"), "1234");
    }

    #[test]
    fn labels_are_thinned_until_they_fit() {
        let axis = Axis::new(0.0, 1.0, (0.0, 1.0), 20).thinned(200.0, 10.0, |_| 30.0);
        assert!(axis.ticks().len() <= 6, "{:?}", axis.ticks());
    }
}
