//! Guards that nearly touch zero: the crossings found are as many as Sturm's theorem counts in exact rational arithmetic
//! (B. L. van der Waerden, *Algebra* I, § 79).
//!
//! The guards are 2ᵏ q(s)² ± r(s) with small integers in q and r: each root of q becomes two roots some 2^(-k/2) apart, or none.
//! Their values are computed exactly and rounded once. A root that q and r share becomes two roots some 2⁻ᵏ apart, and from k = 51 on
//! there may be no number between those: there k is kept below that.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use proptest::prelude::*;
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

/// Falls found one after the other, each root spent before the next search.
fn falls(guard: impl Fn(f64) -> f64) -> usize {
    let (mut count, mut from, mut start) = (0, 0.0, Start::Open);
    while let Some(crossing) = first_fall(|s| guard(from + s), 1.0 - from, start).unwrap().fall {
        (count, from, start) = (count + 1, from + crossing.inside, Start::Spent);
        assert!(count < 20);
    }
    count
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn as_many_crossings_as_sturm_counts(
        q in prop::collection::vec(-9_i64..=9, 2..=4),
        r in prop::collection::vec(-9_i64..=9, 1..=3),
        k in 0_usize..=80,
    ) {
        let q: Polynomial = trimmed(q.into_iter().map(integer).collect());
        let r: Polynomial = r.into_iter().map(integer).collect();
        prop_assume!(q.len() > 1);
        let k = if share_a_root(&q, &trimmed(r.clone())) { k % 32 } else { k };
        let mut p: Polynomial = times(&q, &q).into_iter().map(|c| c * BigRational::from_integer(BigInt::one() << k)).collect();
        p.resize(p.len().max(r.len()), BigRational::zero());
        for (c, r) in p.iter_mut().zip(&r) {
            *c += r;
        }
        let p = trimmed(p);
        prop_assume!(p.len() > 1);
        let ends = [BigRational::zero(), BigRational::one()].map(|s| value(&p, &s));
        prop_assume!(ends.iter().all(|v| !v.is_zero()));
        let Some(roots) = sturm(&p) else { return Ok(()) };
        let guard = |s: f64| value(&p, &BigRational::from_float(s).unwrap()).to_f64().unwrap();
        let found = falls(guard) + falls(|s| -guard(s));
        prop_assert_eq!(found, roots);
    }
}
