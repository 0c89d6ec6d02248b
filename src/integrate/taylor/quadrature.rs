//! Gauss's quadrature on [0, 1].

use super::SeriesKind;

/// Nodes for the integral over a step of a series of order `order`.
///
/// On a window of length h in a series of radius ρ the error of n nodes falls like
/// (h/4ρ)^(2n), that of the series like (h/ρ)^p: with n = p/4 + 2 nodes that of the quadrature is
/// the smaller one. Where there is no such radius, see [`panels`].
pub(super) fn nodes(order: usize) -> usize {
    order / 4 + 2
}

/// Number of equal parts of a step, each with its own nodes.
///
/// Without convolutions the motion is a sum of exponentials, with λh up to 5.5 where the order allows it. The power
/// of a force is their product: n = p/4 + 2 nodes leave less of it on each half than any ε.
pub(super) fn panels(kind: SeriesKind) -> usize {
    match kind {
        SeriesKind::Entire => 2,
        _ => 1,
    }
}

/// Nodes and weights of Gauss's rule with `n` points, 3 ≤ n ≤ 10: exact for polynomials of degree
/// 2n − 1.
///
/// # Panics
/// If `n` is not in the range.
pub(super) fn gauss(n: usize) -> &'static [(f64, f64)] {
    match n {
        3 => &[
            (0.11270166537925831, 0.2777777777777778),
            (0.5, 0.4444444444444444),
            (0.8872983346207417, 0.2777777777777778),
        ],
        4 => &[
            (0.06943184420297371, 0.17392742256872692),
            (0.33000947820757187, 0.32607257743127305),
            (0.6699905217924281, 0.32607257743127305),
            (0.9305681557970263, 0.17392742256872692),
        ],
        5 => &[
            (0.046910077030668004, 0.11846344252809454),
            (0.23076534494715845, 0.23931433524968324),
            (0.5, 0.28444444444444444),
            (0.7692346550528415, 0.23931433524968324),
            (0.953089922969332, 0.11846344252809454),
        ],
        6 => &[
            (0.03376524289842399, 0.08566224618958518),
            (0.16939530676686773, 0.1803807865240693),
            (0.38069040695840156, 0.23395696728634552),
            (0.6193095930415985, 0.23395696728634552),
            (0.8306046932331322, 0.1803807865240693),
            (0.966234757101576, 0.08566224618958518),
        ],
        7 => &[
            (0.025446043828620736, 0.06474248308443485),
            (0.12923440720030277, 0.13985269574463832),
            (0.2970774243113014, 0.19091502525255946),
            (0.5, 0.2089795918367347),
            (0.7029225756886985, 0.19091502525255946),
            (0.8707655927996972, 0.13985269574463832),
            (0.9745539561713793, 0.06474248308443485),
        ],
        8 => &[
            (0.019855071751231884, 0.05061426814518813),
            (0.10166676129318664, 0.11119051722668724),
            (0.2372337950418355, 0.15685332293894363),
            (0.4082826787521751, 0.181341891689181),
            (0.591717321247825, 0.181341891689181),
            (0.7627662049581645, 0.15685332293894363),
            (0.8983332387068134, 0.11119051722668724),
            (0.9801449282487681, 0.05061426814518813),
        ],
        9 => &[
            (0.015919880246186954, 0.040637194180787206),
            (0.0819844463366821, 0.0903240803474287),
            (0.1933142836497048, 0.13030534820146772),
            (0.33787328829809554, 0.15617353852000143),
            (0.5, 0.1651196775006299),
            (0.6621267117019045, 0.15617353852000143),
            (0.8066857163502952, 0.13030534820146772),
            (0.9180155536633179, 0.0903240803474287),
            (0.984080119753813, 0.040637194180787206),
        ],
        10 => &[
            (0.01304673574141414, 0.03333567215434407),
            (0.06746831665550775, 0.0747256745752903),
            (0.1602952158504878, 0.10954318125799102),
            (0.2833023029353764, 0.13463335965499817),
            (0.4255628305091844, 0.14776211235737644),
            (0.5744371694908156, 0.14776211235737644),
            (0.7166976970646236, 0.13463335965499817),
            (0.8397047841495122, 0.10954318125799102),
            (0.9325316833444922, 0.0747256745752903),
            (0.9869532642585859, 0.03333567215434407),
        ],
        _ => panic!("no rule with {n} points"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::ORDERS;
    use super::super::length::order;
    use super::{SeriesKind, gauss, nodes, panels};

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in 3..=nodes(ORDERS - 2) {
            for degree in 0..2 * n as i32 {
                let integral: f64 = gauss(n).iter().map(|(x, w)| w * x.powi(degree)).sum();
                let exact = 1.0 / f64::from(degree + 1);
                assert!(
                    (integral - exact).abs() < 4.0 * f64::EPSILON,
                    "{n} {degree}"
                );
            }
        }
    }

    #[test]
    fn a_product_of_exponentials_is_integrated_to_the_tolerance() {
        // e^(−2 λh s), with the longest step that the order allows.
        for tolerance in [1e-3, 1e-4, 1e-7, 1e-10, 1e-13, 1e-14] {
            let order = order(tolerance, SeriesKind::Entire, 1);
            let factorial: f64 = (1..=order).map(|k| k as f64).product();
            let rate = 2.0 * f64::powf(factorial * tolerance, 1.0 / order as f64);
            let panels = panels(SeriesKind::Entire);
            let parts = panels as f64;
            let integral: f64 = (0..panels)
                .flat_map(|part| {
                    let at = move |&(x, w)| w / parts * f64::exp(-rate * (part as f64 + x) / parts);
                    gauss(nodes(order)).iter().map(at)
                })
                .sum();
            let error = integral * rate / -f64::exp_m1(-rate) - 1.0;
            assert!(error.abs() < tolerance, "{order}: {error:e}");
        }
    }
}
