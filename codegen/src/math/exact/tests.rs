//! Exact numbers against identities, floats and each other.

use super::*;

fn root(n: i64) -> Exact {
    Exact::sqrt_ratio(n, 1)
}

#[test]
fn roots_are_square_free() {
    assert_eq!(root(12), Exact::int(2) * root(3));
    assert_eq!(root(49), Exact::int(7));
    assert_eq!(Exact::sqrt_ratio(8, 27), Exact::ratio(2, 9) * root(6));
    assert_eq!(root(0), Exact::zero());
    let large = 1_000_003_i64;
    assert_eq!(root(large * large), Exact::int(large));
    assert_eq!(root(6 * large) * root(15 * large), Exact::int(3 * large) * root(10));
}

#[test]
fn sums_are_canonical() {
    let a = root(2) + root(3) + Exact::ratio(1, 2);
    let b = Exact::ratio(1, 2) + root(3) + root(2);
    assert_eq!(a, b);
    assert!((&a - &b).is_zero());
    assert_eq!((root(2) + root(3)) * (root(3) - root(2)), Exact::one());
    assert!((root(2) * root(8) / Exact::int(4)).is_one());
    assert_eq!(Exact::pi_sqrt_power(1) * Exact::pi_sqrt_power(-1), Exact::one());
    assert_eq!((0..4).map(Exact::int).sum::<Exact>(), Exact::int(6));
}

#[test]
fn divides_by_conjugation() {
    for divisor in [
        root(2) + Exact::one(),
        root(2) + root(3) + root(5) + Exact::ratio(1, 3),
        root(2) + root(3) + root(5) + root(7),
        (root(6) - root(10)) * Exact::pi_sqrt_power(-3),
        (root(2) + Exact::one()) * Exact::ln_one_plus_sqrt2(),
    ] {
        assert_eq!(Exact::one() / &divisor * &divisor, Exact::one());
        assert!(matches!((Exact::one() / &divisor).0, Form::Sum(_)));
    }
    assert_eq!(Exact::one() / (root(2) - Exact::one()), root(2) + Exact::one());
    let five = root(2) + root(3) + root(5) + root(7) + root(11) + Exact::one();
    assert!(matches!((Exact::one() / &five).0, Form::Real(_)));
    assert!((Exact::one() / &five * five).is_one());
    let mixed = Exact::pi_sqrt_power(2) + Exact::one();
    assert_eq!(&mixed / (&mixed * Exact::ratio(1, 3)), Exact::int(3));
}

#[test]
fn signs_are_decided_past_cancellation() {
    // 3363/2378 is a convergent of √2.
    let close = root(2) - Exact::ratio(3363, 2378);
    assert_eq!(close.signum(), -1);
    assert_eq!(close.abs().signum(), 1);
    let mut tiny = root(2) - Exact::one();
    for _ in 0..7 {
        tiny = &tiny * &tiny;
    }
    assert_eq!(tiny.signum(), 1);
    let expected = (2f64.sqrt() - 1.0).powi(128);
    assert!((tiny.to_f64() / expected - 1.0).abs() < 1e-13);
    assert_eq!(Exact::zero().signum(), 0);
}

#[test]
fn rounds_to_nearest() {
    assert_eq!(Exact::ratio(1, 10).to_f64(), 0.1);
    assert_eq!(Exact::ratio(-1, 10).to_f32(), -0.1);
    assert_eq!(root(2).to_f64(), std::f64::consts::SQRT_2);
    assert_eq!(root(2).to_f32(), std::f32::consts::SQRT_2);
    assert_eq!(Exact::pi_sqrt_power(2).to_f64(), std::f64::consts::PI);
    assert_eq!(Exact::pi_sqrt_power(-2).to_f64(), std::f64::consts::FRAC_1_PI);
    assert_eq!((Exact::int(2) * Exact::pi_sqrt_power(-1)).to_f64(), std::f64::consts::FRAC_2_SQRT_PI);
    assert_eq!(Exact::ln_one_plus_sqrt2().to_f64(), 0.881_373_587_019_543);
    assert_eq!((Exact::one() / Exact::ln_one_plus_sqrt2()).to_f64(), 1.134_592_657_106_511);
    assert_eq!((Exact::one() / Exact::ln_one_plus_sqrt2()).to_real().to_f64(), 1.134_592_657_106_511);
    // √3/(2√π), the band-1 constant.
    assert_eq!((Exact::sqrt_ratio(3, 4) * Exact::pi_sqrt_power(-1)).to_f64(), 0.488_602_511_902_919_9);
}

#[test]
fn rounds_at_the_ends_of_the_range() {
    let power = |e: u32| BigInt::one() << e;
    assert_eq!(Exact::ratio(1, power(149)).to_f32(), f32::from_bits(1));
    assert_eq!(Exact::ratio(1, power(150)).to_f32(), 0.0);
    assert_eq!(Exact::ratio(3, power(150)).to_f32(), f32::from_bits(2));
    assert_eq!(Exact::ratio(power(200) + 1, power(350)).to_f32(), f32::from_bits(1));
    assert_eq!(Exact::ratio(1, power(400)).to_f32(), 0.0);
    assert_eq!(Exact::ratio(1, power(1074)).to_f64(), f64::from_bits(1));
    assert_eq!(Exact::ratio(power(128), 1).to_f32(), f32::INFINITY);
    assert_eq!(Exact::ratio(-power(1024), 1).to_f64(), f64::NEG_INFINITY);
    assert_eq!(Exact::ratio(power(128) - power(103), 1).to_f32(), f32::INFINITY);
    assert_eq!(Exact::ratio(power(128) - power(103) - 1, 1).to_f32(), f32::MAX);
    assert_eq!(Exact::ratio(power(1024) - power(970) - 1, 1).to_f64(), f64::MAX);
    assert_eq!((Exact::ratio(power(300), 1) * root(2)).to_f32(), f32::INFINITY);
    assert_eq!((Exact::ratio(power(300), 1) * root(2)).to_real().to_f64(), 2f64.powi(300) * 2f64.sqrt());
}

#[test]
fn rounds_once() {
    // 1 + 2^-24 is halfway between two f32; 2^-60 more is lost in f64.
    let above: BigInt = BigInt::from((1_i64 << 60) + (1_i64 << 36) + 1);
    let rational = Exact::ratio(above.clone(), 1_i64 << 60);
    assert_eq!(rational.to_f64() as f32, 1.0);
    assert_eq!(rational.to_f32(), 1.0 + f32::EPSILON);
    let surd = Exact::sqrt_ratio(above.pow(2) + 1, BigInt::one() << 120);
    assert_eq!(surd.to_f64() as f32, 1.0);
    assert_eq!(surd.to_f32(), 1.0 + f32::EPSILON);
    let real = Exact::real(rational.to_real());
    assert_eq!(real.to_f32(), 1.0 + f32::EPSILON);
    assert_eq!(Exact::ratio((1 << 24) + 1, 1 << 24).to_f32(), 1.0);
    assert_eq!(Exact::ratio((1 << 24) + 3, 1 << 24).to_f32(), 1.0 + 2.0 * f32::EPSILON);
}

#[test]
fn reals_compute() {
    let third = Real::from_ratio(1, 3);
    let three = Real::from_ratio(3, 1);
    assert_eq!(&third * &three, Real::from_ratio(1, 1));
    assert_eq!(&Real::from_ratio(1, 1) / &three, third);
    assert_eq!(Real::from_ratio(-1, 3).abs(), third);
    let two = Real::from_ratio(2, 1);
    assert!((&two.sqrt() * &two.sqrt() - &two).is_negligible());
    assert_eq!(Real::pi().to_f64(), std::f64::consts::PI);
    assert!(third < three);
    assert!(!Exact::real(third).is_zero());
    assert_eq!(Exact::real(&two.sqrt() * &two.sqrt()), Exact::int(2));
}

#[test]
fn cosines_and_sines() {
    assert_eq!(Real::cos_pi(1, 2), Real::zero());
    assert_eq!(Real::cos_pi(1, 3), Real::from_ratio(1, 2));
    assert_eq!(Real::cos_pi(-2, 3), Real::from_ratio(-1, 2));
    assert_eq!(Real::sin_pi(1, 6), Real::from_ratio(1, 2));
    assert_eq!(Real::sin_pi(7, -6), Real::from_ratio(1, 2));
    assert_eq!(Real::cos_pi(1, 4), Real::from_ratio(1, 2).sqrt());
    for p in -30..30 {
        let (cos, sin) = (Real::cos_pi(p, 7), Real::sin_pi(p, 7));
        let angle = std::f64::consts::PI * p as f64 / 7.0;
        assert!((cos.to_f64() - angle.cos()).abs() < 1e-14);
        assert!((sin.to_f64() - angle.sin()).abs() < 1e-14);
        assert!((&(&cos * &cos) + &(&sin * &sin) - Real::from_ratio(1, 1)).is_negligible());
    }
}

#[test]
fn exact_cosines_are_the_series() {
    for q in [1, 2, 3, 4, 5, 6, 7, 8, 12] {
        for p in -30..30 {
            for (exact, real) in [(Exact::cos_pi(p, q), Real::cos_pi(p, q)), (Exact::sin_pi(p, q), Real::sin_pi(p, q))]
            {
                assert_eq!(exact.to_real(), real);
            }
        }
    }
}

#[test]
fn roots_of_numbers() {
    assert_eq!(Exact::ratio(4, 9).sqrt(), Exact::ratio(2, 3));
    assert_eq!(Exact::ratio(3, 7).sqrt(), Exact::sqrt_ratio(3, 7));
    let nested = (Exact::int(2) + root(2)).sqrt();
    assert_eq!(nested, Exact::int(2) * Exact::cos_pi(1, 8));
    assert_eq!(Exact::zero().sqrt(), Exact::zero());
}

#[test]
fn a_real_agrees_with_its_sum() {
    for sum in [
        root(7) - Exact::ratio(5, 3),
        Exact::pi_sqrt_power(-3) * root(5),
        Exact::ratio(11, 12) * root(2) - Exact::ratio(3, 4) * Exact::ln_one_plus_sqrt2(),
    ] {
        assert!((Exact::real(sum.to_real()) - &sum).is_zero());
        assert_eq!(Exact::real(sum.to_real()).to_f64(), sum.to_f64());
        assert_eq!(Exact::real(sum.to_real()).signum(), sum.signum());
    }
}
