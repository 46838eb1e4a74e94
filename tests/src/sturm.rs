//! Guards that nearly touch zero, and how often they cross it by Sturm's theorem in exact rational
//! arithmetic (B. L. van der Waerden, *Algebra* I, § 79).

#![allow(clippy::unwrap_used)] // numbers that are finite can be made rational

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use saltus::cross::{Start, first_fall};

/// Coefficients, lowest first, the last one not zero.
type Polynomial = Vec<BigRational>;

fn integer(n: i64) -> BigRational {
    BigRational::from_integer(BigInt::from(n))
}

fn trimmed(mut p: Polynomial) -> Polynomial {
    while p.last().is_some_and(Zero::is_zero) {
        p.pop();
    }
    p
}

fn times(p: &Polynomial, q: &Polynomial) -> Polynomial {
    let mut product = vec![BigRational::zero(); p.len() + q.len() - 1];
    for (i, a) in p.iter().enumerate() {
        for (j, b) in q.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

fn value(p: &Polynomial, s: &BigRational) -> BigRational {
    p.iter().rev().fold(BigRational::zero(), |sum, c| sum * s + c)
}

/// The remainder of p by q.
fn remainder(p: &Polynomial, q: &Polynomial) -> Polynomial {
    let mut rest = p.clone();
    while rest.len() >= q.len() {
        let factor = rest.last().unwrap() / q.last().unwrap();
        let shift = rest.len() - q.len();
        for (i, c) in q.iter().enumerate() {
            let part = &factor * c;
            rest[i + shift] -= part;
        }
        rest.pop();
        rest = trimmed(rest);
    }
    rest
}

/// Whether p and q have a common divisor that is not a constant.
fn share_a_root(p: &Polynomial, q: &Polynomial) -> bool {
    let (mut p, mut q) = (p.clone(), q.clone());
    while !q.is_empty() {
        (p, q) = (q.clone(), remainder(&p, &q));
    }
    p.len() > 1
}

/// How many roots p has in (0, 1], each counted once; `None` if one of them is multiple.
fn sturm(p: &Polynomial) -> Option<usize> {
    let derivative = p.iter().enumerate().skip(1).map(|(k, c)| c * integer(k as i64)).collect();
    let mut chain = vec![p.clone(), derivative];
    loop {
        let [.., a, b] = &chain[..] else { return None };
        let next: Polynomial = remainder(a, b).into_iter().map(|c| -c).collect();
        if next.is_empty() {
            break;
        }
        chain.push(next);
    }
    if chain.last().unwrap().len() > 1 {
        return None;
    }
    let changes = |s: &BigRational| {
        let signs: Vec<bool> =
            chain.iter().map(|p| value(p, s)).filter(|v| !v.is_zero()).map(|v| v.is_positive()).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    Some(changes(&BigRational::zero()) - changes(&BigRational::one()))
}

/// The value at s, exact and rounded once, of a polynomial with whole coefficients.
fn rounded(p: &[BigInt], s: f64) -> f64 {
    // With s = m/d it is a whole number over a power of d; no common divisor has to be found.
    let s = BigRational::from_float(s).unwrap();
    let (mut sum, mut below, mut next) = (BigInt::zero(), BigInt::one(), BigInt::one());
    for c in p.iter().rev() {
        sum = sum * s.numer() + c * &next;
        below.clone_from(&next);
        next *= s.denom();
    }
    BigRational::new_raw(sum, below).to_f64().unwrap()
}

/// Falls found one after the other, each root spent before the next search.
fn falls(guard: impl Fn(f64) -> f64) -> usize {
    let (mut count, mut from, mut start) = (0, 0.0, Start::Open);
    while let Some(crossing) = first_fall(|s| guard(from + s), 1.0 - from, start).unwrap().fall {
        (count, from, start) = (count + 1, from + crossing.inside, Start::Spent);
        assert!(count < 20);
    }
    count
}

/// How many crossings of 2ᵏ q(s)² + r(s) in (0, 1] are found, and how many there are; `None` where
/// counting has no say: no polynomial, a root at an end, or a multiple one.
///
/// Each root of q becomes two roots some 2^(-k/2) apart, or none. Values are computed exactly and
/// rounded once. A root that q and r share becomes two roots some 2⁻ᵏ apart, and from k = 51 on
/// there may be no number between those: there k is kept below that.
#[must_use]
pub fn found_and_counted(q: &[i64], r: &[i64], k: usize) -> Option<(usize, usize)> {
    let rational = |p: &[i64]| p.iter().copied().map(integer).collect();
    let (q, r): (Polynomial, Polynomial) = (trimmed(rational(q)), rational(r));
    if q.len() < 2 {
        return None;
    }
    let k = if share_a_root(&q, &trimmed(r.clone())) { k % 32 } else { k };
    let size = BigRational::from_integer(BigInt::one() << k);
    let mut p: Polynomial = times(&q, &q).into_iter().map(|c| c * &size).collect();
    p.resize(p.len().max(r.len()), BigRational::zero());
    for (c, r) in p.iter_mut().zip(&r) {
        *c += r;
    }
    let p = trimmed(p);
    if p.len() < 2 || [BigRational::zero(), BigRational::one()].iter().any(|s| value(&p, s).is_zero()) {
        return None;
    }
    let counted = sturm(&p)?;
    let whole: Vec<BigInt> = p.iter().map(BigRational::to_integer).collect();
    let guard = |s: f64| rounded(&whole, s);
    Some((falls(guard) + falls(|s| -guard(s)), counted))
}
