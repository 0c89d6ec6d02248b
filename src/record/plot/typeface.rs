//! The letters of PNG and PDF: DejaVu Sans, which travels inside, so that a picture is the same on every machine. Its
//! licence is `assets/dejavu-LICENSE`.

use super::canvas::{Anchor, Font, Position, UNITS};
use super::marked::{END_SUB, SUB};
use ttf_parser::{Face, GlyphId};

/// Height of a subscript in em of the text, and how far below the text it stands; as in `svg.rs`.
const SUBSCRIPT: f64 = 0.7;
const DROP: f64 = 0.21;

/// A face of the family.
pub(super) struct Typeface {
    pub data: &'static [u8],
    pub face: Face<'static>,
}

/// A glyph of a text on its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Glyph {
    pub id: GlyphId,
    pub letter: char,
    /// Where its origin is, along the text from its start and up from its baseline, and its size (em); in the units of marks.
    pub along: f64,
    pub up: f64,
    pub size: f64,
}

/// A text with the places of its glyphs.
pub(super) struct Line {
    pub glyphs: Vec<Glyph>,
    at: Position,
    upwards: bool,
    /// From the place of the text to the start of its line, along and up.
    start: (f64, f64),
}

impl Typeface {
    pub fn new(bold: bool) -> Typeface {
        let data = match bold {
            true => dejavu::sans::bold(),
            false => dejavu::sans::regular(),
        };
        let face = Face::parse(data, 0).expect("the family is well-formed");
        Typeface { data, face }
    }

    /// What a length in the design of the letters is, in em.
    pub fn em(&self, length: impl Into<f64>) -> f64 {
        length.into() / f64::from(self.face.units_per_em())
    }

    /// Width of a glyph, em.
    pub fn advance(&self, id: GlyphId) -> f64 {
        self.em(self.face.glyph_hor_advance(id).unwrap_or(0))
    }

    /// Height of a letter above its baseline, em; the tables of the family do not say it.
    pub fn height(&self, letter: char) -> f64 {
        let glyph = self.face.glyph_index(letter);
        let bounds = glyph.and_then(|glyph| self.face.glyph_bounding_box(glyph));
        self.em(bounds.map_or(0, |bounds| bounds.y_max))
    }

    /// Places the letters of a text. Letters that the family does not have are its empty box.
    pub fn line(&self, text: &str, at: Position, anchor: Anchor, font: Font) -> Line {
        let full = font.size * UNITS;
        let (mut along, mut size, mut up) = (0.0, full, 0.0);
        let mut glyphs = Vec::new();
        for letter in text.chars() {
            match letter {
                SUB => (size, up) = (full * SUBSCRIPT, -full * DROP),
                END_SUB => (size, up) = (full, 0.0),
                _ => {
                    let id = self.face.glyph_index(letter).unwrap_or(GlyphId(0));
                    glyphs.push(Glyph {
                        id,
                        letter,
                        along,
                        up,
                        size,
                    });
                    along += self.advance(id) * size;
                }
            }
        }
        let back = match anchor {
            Anchor::Left | Anchor::UpwardsFrom => 0.0,
            Anchor::Centre | Anchor::Upwards => along / 2.0,
            Anchor::Right | Anchor::UpwardsTo => along,
        };
        // Small letters are halfway up at their place.
        let height = self.height('x') * full;
        let upwards = matches!(
            anchor,
            Anchor::Upwards | Anchor::UpwardsFrom | Anchor::UpwardsTo
        );
        Line {
            glyphs,
            at,
            upwards,
            start: (-back, -height / 2.0),
        }
    }
}

impl Line {
    /// The matrix from em of a glyph, to the right and up, to the units of marks, to the right and down, in the order of
    /// PostScript.
    pub fn matrix(&self, glyph: &Glyph) -> [f32; 6] {
        let (along, up) = (self.start.0 + glyph.along, self.start.1 + glyph.up);
        let (x, y) = (f64::from(self.at.0), f64::from(self.at.1));
        let size = glyph.size;
        let matrix = match self.upwards {
            false => [size, 0.0, 0.0, -size, x + along, y - up],
            true => [0.0, -size, -size, 0.0, x - up, y - along],
        };
        matrix.map(|x| x as f32)
    }
}
