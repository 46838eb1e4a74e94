//! Elementary functions of the fit: the same to the last bit on every machine.
//!
//! Those of [`f64`] are the system's, and differ between systems, their versions and their
//! processors in the last bit. A fit takes thousands of steps from them and then decides: whether
//! it has arrived, which of two models is better, whether there is a trend. So a bit can become
//! a sentence. These are one library's, compiled with the fit; the lints of this crate
//! (`clippy.toml`) keep the others out. Roots, sums and products are exact everywhere.

pub(crate) use libm::{
    asinh, atan, atanh, cos, exp, expm1 as exp_m1, hypot, log as ln, log1p as ln_1p, pow as powf, sin,
    sincos as sin_cos, sinh, tan, tanh,
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Bits as they come on every machine, in a browser too, and right to two units of the last.
    #[test]
    fn bits_are_the_same_everywhere() {
        let x = 0.7_f64;
        for (got, bits) in [
            (ln(x), 0xbfd6_d3c3_24e1_3f50_u64),
            (exp(x), 0x4000_1c2a_6126_8987),
            (powf(x, 0.1), 0x3fee_e0f6_172e_7679),
            (sin(x), 0x3fe4_9d6e_6946_19b8),
            (atan(x), 0x3fe3_8b11_2d7b_d4ad),
            (ln_1p(x), 0x3fe0_fae8_1914_a991),
            (exp_m1(x), 0x3ff0_3854_c24d_130d),
            (tanh(x), 0x3fe3_56fb_17af_2e90),
            (hypot(x, 0.3), 0x3fe8_5ed7_614b_038c),
        ] {
            assert_eq!(got.to_bits(), bits, "{got}");
        }
        for (got, system) in [(ln(x), x.ln()), (exp(x), x.exp()), (tanh(x), x.tanh()), (sin_cos(x).1, x.cos())] {
            assert!((got - system).abs() <= 2.0 * f64::EPSILON * system.abs(), "{got} {system}");
        }
    }
}
