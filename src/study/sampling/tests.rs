use std::f64::consts::PI;

use serde_json::Value;

use super::*;

fn references() -> Value {
    serde_json::from_str(include_str!("../../../tests/data/21_sampling.json")).unwrap()
}

fn point(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().unwrap().iter();
    numbers.map(|x| x.as_f64().unwrap()).collect()
}

/// A quotient as a text.
fn fraction(value: &Value) -> f64 {
    let (above, below) = value
        .as_str()
        .unwrap()
        .split_once('/')
        .unwrap_or(("0", "1"));
    above.parse::<f64>().unwrap() / below.parse::<f64>().unwrap()
}

#[test]
fn sobol_points_are_those_of_joe_and_kuo() {
    let references = references();
    let first = references["sobol_3d_first16_unscrambled"]
        .as_array()
        .unwrap();
    for (mine, theirs) in Sobol::new(3).zip(first) {
        assert_eq!(mine, point(theirs));
    }
    for (index, theirs) in references["sobol_10d_points_0_8_33_63"]
        .as_object()
        .unwrap()
    {
        let mine = Sobol::new(10).nth(index.parse().unwrap()).unwrap();
        assert_eq!(mine, point(theirs), "{index}");
    }
}

#[test]
fn sobol_points_are_one_in_each_stratum_of_every_dimension_shifted_too() {
    for points in [Sobol::new(Sobol::MOST), Sobol::shifted(Sobol::MOST, 7)] {
        let points: Vec<_> = points.take(256).collect();
        for d in 0..Sobol::MOST {
            let mut strata: Vec<_> = points.iter().map(|x| (x[d] * 256.0) as usize).collect();
            strata.sort_unstable();
            assert!(strata.into_iter().eq(0..256), "dimension {d}");
        }
    }
    let inside = |x: &f64| *x > 0.0 && *x < 1.0;
    assert!(
        Sobol::shifted(10, 1)
            .take(4096)
            .flatten()
            .all(|x| inside(&x))
    );
}

#[test]
fn halton_points_are_mirrored_digits() {
    let references = references();
    for (i, theirs) in references["halton_3d_first16_fractions"]
        .as_array()
        .unwrap()
        .iter()
        .enumerate()
    {
        let theirs: Vec<_> = theirs.as_array().unwrap().iter().map(fraction).collect();
        assert_eq!(halton(i as u64, 3), theirs);
    }
    let theirs = references["halton_6d_index_1000_fractions"]
        .as_array()
        .unwrap();
    assert_eq!(
        halton(1000, 6),
        theirs.iter().map(fraction).collect::<Vec<_>>()
    );
    assert!(halton(u64::MAX, 6).iter().all(|x| *x < 1.0));
}

#[test]
fn integrals_are_as_good_as_those_of_the_references() {
    let check = &references()["integration_check"];
    let f = |x: &[f64]| x.iter().map(|x| 0.5 * PI * (PI * x).sin()).product::<f64>();
    for n in [64, 256, 1024, 4096] {
        let sobol = Sobol::new(3).take(n).map(|x| f(&x)).sum::<f64>() / n as f64;
        let halton = (0..n as u64).map(|i| f(&halton(i, 3))).sum::<f64>() / n as f64;
        for (name, mine) in [("sobol", sobol), ("halton", halton)] {
            let theirs = check[&format!("{name}_3d_n{n}")].as_f64().unwrap();
            assert!((mine - theirs).abs() < 1e-12, "{name} {n}: {mine} {theirs}");
        }
    }
}

#[test]
fn every_stratum_of_a_latin_hypercube_has_a_point() {
    for centred in [false, true] {
        for n in [1, 2, 3, 49, 50, 1000] {
            let points = latin_hypercube(n, 4, 3, centred);
            for d in 0..4 {
                let mut strata: Vec<_> =
                    points.iter().map(|x| (x[d] * n as f64) as usize).collect();
                strata.sort_unstable();
                assert!(strata.into_iter().eq(0..n), "{n} points, dimension {d}");
            }
            assert!(points.iter().flatten().all(|x| *x > 0.0 && *x < 1.0));
        }
    }
    assert!(latin_hypercube(0, 2, 1, false).is_empty());
    assert_eq!(
        latin_hypercube(9, 2, 1, false),
        latin_hypercube(9, 2, 1, false)
    );
    assert_ne!(
        latin_hypercube(9, 2, 1, false),
        latin_hypercube(9, 2, 2, false)
    );
}

/// In four dimensions the mean of Σ xᵢ varies by (4/12)/n³ instead of (4/12)/n.
#[test]
fn latin_hypercubes_reduce_the_variance() {
    let (n, seeds) = (50, 4000);
    let mean = |seed| {
        latin_hypercube(n, 4, seed, false)
            .iter()
            .flatten()
            .sum::<f64>()
            / n as f64
    };
    let squares: f64 = (0..seeds)
        .map(|seed| (mean(seed) - 2.0) * (mean(seed) - 2.0))
        .sum();
    let ratio = squares / seeds as f64 / (4.0 / 12.0 / 125_000.0);
    // Of 4000 the relative standard deviation is √(2/4000) = 0.022: four of them.
    assert!((ratio - 1.0).abs() < 0.09, "{ratio}");
}

#[test]
fn random_bits_are_those_of_the_published_generator() {
    let mut random = Random::new(1_234_567);
    let published = [
        6_457_827_717_110_365_317,
        3_203_168_211_198_807_973,
        9_817_491_932_198_370_423_u64,
    ];
    assert_eq!(published.map(|_| random.bits()), published);
}
