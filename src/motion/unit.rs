//! Units as records write them. Here `g` is gravity, never the gram.

/// Standard gravity in m/s², by definition (3rd CGPM, 1901).
pub const GRAVITY: f64 = 9.806_65;

/// A unit of acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// How it is shown.
    pub name: &'static str,
    /// The unit in m/s².
    pub factor: f64,
}

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Measure {
    Acceleration(Unit),
    Velocity,
    Displacement,
    /// Seconds to the unit.
    Time(f64),
    /// Digitizer counts.
    Counts,
}

/// Symbols without blanks, signs of powers and `sec`, in lower case.
const ACCELERATIONS: [(&[&str], Unit); 7] = [
    (
        &["g", "g_n", "gn", "g0"],
        Unit {
            name: "g",
            factor: GRAVITY,
        },
    ),
    (
        &["mg"],
        Unit {
            name: "mg",
            factor: GRAVITY * 1e-3,
        },
    ),
    (
        &[
            "m/s2", "m/s/s", "m_s2", "ms2", "ms-2", "mps2", "mpss", "m_s-2", "m/(s2)",
        ],
        Unit {
            name: "m/s^2",
            factor: 1.0,
        },
    ),
    (
        &[
            "cm/s2", "cm/s/s", "cm_s2", "cms2", "cms-2", "cmps2", "cm_s-2", "cm/(s2)", "gal",
            "gals",
        ],
        Unit {
            name: "cm/s^2",
            factor: 0.01,
        },
    ),
    (
        &["mm/s2", "mm/s/s", "mm_s2", "mms2", "mms-2", "mm/(s2)"],
        Unit {
            name: "mm/s^2",
            factor: 0.001,
        },
    ),
    // By definition an inch is 25.4 mm and a foot 12 inches.
    (
        &["in/s2", "in/s/s", "in_s2"],
        Unit {
            name: "in/s^2",
            factor: 0.0254,
        },
    ),
    (
        &["ft/s2", "ft/s/s", "ft_s2"],
        Unit {
            name: "ft/s^2",
            factor: 0.3048,
        },
    ),
];

impl Unit {
    /// Reads `g`, `m/s^2`, `cm/s2`, `CM/SEC/SEC`, `gal` and their other spellings.
    pub fn parse(text: &str) -> Option<Unit> {
        let text = plain(text);
        let known = |(symbols, unit): &(&[&str], Unit)| symbols.contains(&&*text).then_some(*unit);
        ACCELERATIONS.iter().find_map(known)
    }

    /// The names of all units.
    pub fn names() -> impl Iterator<Item = &'static str> {
        ACCELERATIONS.iter().map(|(_, unit)| unit.name)
    }
}

/// A symbol without what its spellings differ in.
fn plain(text: &str) -> String {
    let lower = text.trim().to_lowercase();
    let signs = lower
        .replace('²', "2")
        .replace("⁻²", "-2")
        .replace("**", "")
        .replace('⁻', "-");
    let letters: String = signs
        .chars()
        .filter(|c| !c.is_whitespace() && !"^*·.".contains(*c))
        .collect();
    letters
        .replace("seconds", "s")
        .replace("second", "s")
        .replace("sec", "s")
}

/// What a unit measures; `None` if it is not known.
pub(super) fn measure(text: &str) -> Option<Measure> {
    if let Some(unit) = Unit::parse(text) {
        return Some(Measure::Acceleration(unit));
    }
    match &*plain(text) {
        "s" => Some(Measure::Time(1.0)),
        "ms" | "millis" => Some(Measure::Time(1e-3)),
        "m/s" | "cm/s" | "mm/s" | "in/s" | "ft/s" | "m_s" | "cm_s" | "mm_s" => {
            Some(Measure::Velocity)
        }
        "m" | "cm" | "mm" | "in" | "ft" => Some(Measure::Displacement),
        "count" | "counts" => Some(Measure::Counts),
        _ => None,
    }
}
