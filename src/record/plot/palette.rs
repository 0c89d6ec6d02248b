//! Colours that people with any colour vision can tell apart.

use plotters::style::RGBColor;

/// What is drawn on.
pub(super) const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xff);
/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// What is said on the side.
pub(super) const FAINT: RGBColor = RGBColor(0x66, 0x66, 0x66);
/// Grid lines.
pub(super) const GRID: RGBColor = RGBColor(0xe4, 0xe4, 0xe4);
/// The line of zero.
pub(super) const ZERO: RGBColor = RGBColor(0xaa, 0xaa, 0xaa);
/// A failure.
pub(super) const ALARM: RGBColor = RGBColor(0xd5, 0x5e, 0x00);

/// Lines: M. Okabe and K. Ito, "Color Universal Design" (2008), without the yellow, which is too
/// pale for a thin line on white.
const LINES: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0x00, 0x00, 0x00),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
];

/// Areas: the scheme "light" of P. Tol, "Colour Schemes", SRON/EPS/TN/09-002 (2021), ordered so
/// that neighbours differ most.
const AREAS: [RGBColor; 9] = [
    RGBColor(0x77, 0xaa, 0xdd),
    RGBColor(0xee, 0x88, 0x66),
    RGBColor(0x44, 0xbb, 0x99),
    RGBColor(0xee, 0xdd, 0x88),
    RGBColor(0xff, 0xaa, 0xbb),
    RGBColor(0xbb, 0xcc, 0x33),
    RGBColor(0x99, 0xdd, 0xff),
    RGBColor(0xaa, 0xaa, 0x00),
    RGBColor(0xdd, 0xdd, 0xdd),
];

/// Number of lines that have a colour of their own.
pub(super) const LINE_COLOURS: usize = LINES.len();

/// Colour of the `i`-th line of a panel.
pub(super) fn line(i: usize) -> RGBColor {
    LINES[i % LINES.len()]
}

/// Colour of the `i`-th mode.
pub(super) fn area(i: usize) -> RGBColor {
    AREAS[i % AREAS.len()]
}
