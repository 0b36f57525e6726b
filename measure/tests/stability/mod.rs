//! What the report on the extremes promises.

use crate::fresh;
use zonal_measure::stability::Stability;
use zonal_measure::stability::basis::{NUMBERS, PLACES};
use zonal_measure::stability::euler::MULTIPLES;
use zonal_measure::stability::report::{BASIS_TARGET, ROTATION_TARGET};
use zonal_measure::stability::rotation::Way;
use zonal_measure::stability::special::{QUATERNIONS, VALUES};

/// The unit roundoff of f32.
const UNIT: f64 = f32::EPSILON as f64 / 2.0;

fn found() -> &'static Stability {
    &fresh().stability
}

fn basis(number: &str, place: &str, order: usize) -> f64 {
    let curve = found().basis.iter().find(|curve| curve.number == number && curve.place == place).unwrap();
    curve.at_order(order).unwrap()
}

fn rotation(way: Way, number: &str, order: usize) -> f64 {
    let curve = found().rotation.iter().find(|curve| curve.number == number && curve.way == way.name()).unwrap();
    curve.at_order(order).unwrap()
}

#[test]
fn the_basis_is_finite_and_accurate_to_its_highest_orders() {
    assert_eq!(found().basis.len(), NUMBERS.len() * PLACES.len());
    assert!(found().basis.iter().all(|curve| curve.not_finite == 0));
    for place in PLACES {
        // What a search by other code found with 1e6 directions: 8e-6 in f32 at order 64, 3.7e-3 in f16 at order 8.
        assert!(basis("f32", place, 64) <= BASIS_TARGET, "{place}");
        assert!(basis("f16", place, 8) <= 4e-3, "{place}");
        // In f64 as in f32, by their units roundoff, and twice that at twice the order.
        assert!(basis("f64", place, 64) <= BASIS_TARGET * f64::EPSILON / f64::from(f32::EPSILON) * 2.0, "{place}");
        assert!(basis("f64", place, 128) <= BASIS_TARGET * f64::EPSILON / f64::from(f32::EPSILON) * 4.0, "{place}");
    }
    // It is the poles that cost.
    assert!(basis("f32", "anywhere", 64) < 3e-6 && basis("f32", "equator", 64) < 3e-6);
    assert!(basis("f32", "pole", 64) > basis("f32", "anywhere", 64));
}

#[test]
fn exact_rotations_are_flat_to_order_64_once_their_multiples_are_right() {
    for way in [Way::Multiples, Way::Normalised] {
        assert!(rotation(way, "f32", 64) <= ROTATION_TARGET, "{way:?}");
        assert!(rotation(way, "f32", 64) <= 2.0 * rotation(way, "f32", 4), "{way:?}");
    }
    assert!(rotation(Way::Multiples, "f64", 64) <= ROTATION_TARGET * f64::EPSILON / f64::from(f32::EPSILON));
    assert!(rotation(Way::Straight, "f32", 16) <= ROTATION_TARGET);
    // Multiples and the set-up cost as many units as the band is high: 2 m a product, 7.5 m the set-up by hand.
    for (way, units) in [(Way::Pairs, 2.0), (Way::WideSetup, 2.0), (Way::Quaternion, 9.5)] {
        for order in [4, 8, 16, 32, 64] {
            let error = rotation(way, "f32", order);
            assert!(error <= units * order as f64 * UNIT, "{way:?} {order}: {error}");
        }
        assert!(rotation(way, "f32", 64) > ROTATION_TARGET, "{way:?} is better than the report says");
    }
}

#[test]
fn the_recursion_loses_what_the_exact_rotation_keeps() {
    for number in ["f32", "f64"] {
        assert!(rotation(Way::Recursion, number, 8) < 10.0 * rotation(Way::Multiples, number, 8));
        assert!(rotation(Way::Recursion, number, 64) > 1e4 * rotation(Way::Multiples, number, 64));
    }
    for derivative in &found().derivatives {
        let (unit, last) =
            (if derivative.number == "f32" { UNIT } else { f64::EPSILON / 2.0 }, derivative.errors.len() - 1);
        match derivative.angle {
            0 => assert!(derivative.errors.iter().flatten().all(|error| *error < 8.0 * unit), "{derivative:?}"),
            _ => assert!(derivative.errors[last].iter().all(|error| *error > 1e3 * unit), "{derivative:?}"),
        }
    }
}

#[test]
fn the_angles_of_a_rotation_are_those_of_the_rotation() {
    for row in &found().euler {
        // Noise of 1e-7 an entry, a quaternion's rounding and 7.5 units of the set-up.
        let [quaternion, by_quaternion, sequential, tangents, cosine] = row.errors;
        assert!(quaternion < 8.0 * UNIT, "{row:?}");
        assert!(by_quaternion < 8.0 * UNIT + 2e-7 && sequential < 8.0 * UNIT + 2e-7, "{row:?}");
        if row.angle <= 1e-7 {
            assert!(tangents > 0.5 && cosine > 0.5, "{row:?}");
        }
    }
    assert_eq!(found().euler.iter().filter(|row| row.from_pi).count() * 2, found().euler.len());
}

#[test]
fn multiples_err_by_two_units_each() {
    for multiples in &found().multiples {
        let unit = if multiples.number == "f32" { UNIT } else { f64::EPSILON / 2.0 };
        let products = multiples.way.contains("products");
        for (m, error) in MULTIPLES.iter().zip(multiples.errors) {
            assert!(!products || error <= 2.0 * *m as f64 * unit, "{multiples:?}");
        }
        // Chebyshev's recurrence grows with the square of m near 0 and π.
        assert!(products || multiples.angles == "anywhere" || multiples.errors[3] > 500.0 * unit, "{multiples:?}");
    }
}

#[test]
fn a_hundred_thousand_rotations_keep_the_norm_as_well_as_one_does() {
    for drift in &found().chain {
        let unit = if drift.number == "f32" { UNIT } else { f64::EPSILON / 2.0 };
        let last = drift.norms[4];
        match drift.spec.split(':').next().unwrap() {
            "rotate" | "zhf" | "rotate_y" => {
                // One unit each, in one direction at the worst.
                assert!(last.unwrap() < 1e5 * unit, "{drift:?}");
            }
            "lf3" => assert!(drift.norms.iter().all(|norm| norm.unwrap() < 5e-3), "{drift:?}"),
            "taylor1" | "taylor15" => assert!(last.is_none() && drift.norms[0].is_some(), "{drift:?}"),
            _ => {}
        }
    }
}

#[test]
fn bands_do_not_mix_and_keep_what_they_can() {
    assert!(found().special.len() >= 12 * VALUES.len());
    for outcome in &found().special {
        assert!(outcome.others_unchanged, "{outcome:?}");
        match outcome.value.as_str() {
            "infinite" | "NaN" => assert!(!outcome.finite, "{outcome:?}"),
            "1e38" => assert!(outcome.finite && outcome.error.unwrap() < 1e-6, "{outcome:?}"),
            // At most half a unit lost in each step of a coefficient, five of them and a root of five coefficients.
            _ => assert!(outcome.finite && outcome.units.unwrap() < 8.0, "{outcome:?}"),
        }
    }
}

/// The promises of the crate `zonal`.
#[test]
fn quaternions_that_are_none_do_what_is_promised() {
    for bent in &found().bent {
        let slope = if bent.spec == "rotate:3" { 15.0 } else { 5.0 };
        let most = |away: f64| slope * away;
        match QUATERNIONS.iter().position(|input| *input == bent.input).unwrap() {
            0 => assert!(bent.change.unwrap() <= most(1e-6), "{bent:?}"),
            1 => assert!(bent.change.unwrap() <= most(1e-3), "{bent:?}"),
            2 => assert!(bent.change.unwrap() <= most(0.1), "{bent:?}"),
            // −q is the same rotation; the tiny number that keeps phases defined rounds otherwise.
            3 => assert!(bent.change.unwrap() <= 8.0 * UNIT, "{bent:?}"),
            4 => assert!(bent.finite || bent.all_nan, "{bent:?}"),
            _ => assert!(bent.all_nan, "{bent:?}"),
        }
        assert!(bent.band_0, "{bent:?}");
    }
}

#[test]
fn lobes_err_by_their_condition() {
    for set in &found().lobes {
        // ‖Yᵀ‖ ‖Âᵀ‖ is the condition; each of the two products and the two tables is rounded.
        assert!(set.error < 4.0 * UNIT * set.condition, "{set:?}");
    }
    assert_eq!(found().lobes.iter().filter(|set| set.chosen).count(), 27);
}
