//! Pictures as PDF of one page, by pdf-writer. Texts are texts, to be searched and copied, in a subset of the typeface.

use super::canvas::{Mark, Picture, Position, UNITS};
use super::typeface::Typeface;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};
use plotters::style::RGBColor;
use std::collections::BTreeMap;
use subsetter::GlyphRemapper;

/// A point is 1/72 of an inch, of which the picture's pixels are 1/96.
const POINTS: f64 = 72.0 / 96.0;
/// A cubic whose control points are this part of the radius from its ends is a quarter of a circle to 3e-4 of the
/// radius: 4/3 (√2 − 1).
const QUARTER: f32 = 0.552_284_8;
/// SVG bevels corners of lines that would stick out further.
const MITER_LIMIT: f32 = 4.0;
/// Compression that is nearly the best, in little time.
const LEVEL: u8 = 6;
/// Names of the faces in the file; the letters in front of a font's name say that it is a subset.
const FACES: [(&[u8], &[u8]); 2] = [
    (b"F0", b"DALEMB+DejaVuSans"),
    (b"F1", b"DALEMB+DejaVuSans-Bold"),
];
const SYSTEM: SystemInfo = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};

/// The glyphs of a face that a picture has, with numbers of their own, and the letters they are.
struct Used {
    typeface: Typeface,
    glyphs: GlyphRemapper,
    letters: BTreeMap<u16, char>,
}

impl Picture {
    /// The picture as PDF.
    pub fn pdf(&self) -> Vec<u8> {
        let mut faces = [false, true].map(Used::new);
        let drawn = compressed(&self.content(&mut faces));
        let mut next = 0;
        let mut reference = || {
            next += 1;
            Ref::new(next)
        };
        let (catalog, pages, page, content) = (reference(), reference(), reference(), reference());
        let of_faces: Vec<[Ref; 5]> = (faces.iter())
            .map(|_| std::array::from_fn(|_| reference()))
            .collect();
        let (width, height) = (self.size.0 * POINTS, self.size.1 * POINTS);
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let mut sheet = pdf.page(page);
        sheet.parent(pages).contents(content);
        sheet.media_box(Rect::new(0.0, 0.0, width as f32, height as f32));
        let mut resources = sheet.resources();
        let mut fonts = resources.fonts();
        let used = || {
            let all = faces.iter().zip(&of_faces).zip(FACES);
            all.filter(|((face, _), _)| !face.letters.is_empty())
        };
        for ((_, references), (name, _)) in used() {
            fonts.pair(Name(name), references[0]);
        }
        fonts.finish();
        resources.finish();
        sheet.finish();
        pdf.stream(content, &drawn).filter(Filter::FlateDecode);
        for ((face, references), (_, name)) in used() {
            face.write(&mut pdf, *references, Name(name));
        }
        pdf.finish()
    }

    /// What is drawn, in the units of marks, to the right and down.
    fn content(&self, faces: &mut [Used; 2]) -> Vec<u8> {
        let mut out = Content::new();
        let scale = (POINTS / UNITS) as f32;
        let height = (self.size.1 * POINTS) as f32;
        out.transform([scale, 0.0, 0.0, -scale, 0.0, height]);
        out.set_miter_limit(MITER_LIMIT);
        for mark in &self.marks {
            draw(&mut out, mark, faces);
        }
        out.finish().into_vec()
    }
}

fn draw(out: &mut Content, mark: &Mark, faces: &mut [Used; 2]) {
    match mark {
        Mark::Line {
            path,
            width,
            colour,
        } => {
            let [r, g, b] = parts(*colour);
            out.set_stroke_rgb(r, g, b).set_line_width(*width as f32);
            line(out, path);
            out.stroke();
        }
        Mark::Polygon { path, colour } => {
            fill_with(out, *colour);
            line(out, path);
            out.close_path().fill_nonzero();
        }
        Mark::Rectangle {
            corners: [(x0, y0), (x1, y1)],
            colour,
        } => {
            fill_with(out, *colour);
            let (width, height) = ((x1 - x0) as f32, (y1 - y0) as f32);
            out.rect(*x0 as f32, *y0 as f32, width, height);
            out.fill_nonzero();
        }
        Mark::Disc {
            centre,
            radius,
            colour,
        } => {
            fill_with(out, *colour);
            disc(out, *centre, *radius as f32);
            out.fill_nonzero();
        }
        Mark::Text {
            text,
            at,
            anchor,
            font,
        } => {
            let bold = usize::from(font.bold);
            let face = &mut faces[bold];
            let line = face.typeface.line(text, *at, *anchor, *font);
            fill_with(out, font.colour);
            out.begin_text();
            out.set_font(Name(FACES[bold].0), 1.0);
            // Glyphs of one size and height follow each other by their widths.
            for glyphs in line
                .glyphs
                .chunk_by(|a, b| (a.size, a.up) == (b.size, b.up))
            {
                let numbers = glyphs.iter().flat_map(|glyph| {
                    let number = face.glyphs.remap(glyph.id.0);
                    face.letters.entry(number).or_insert(glyph.letter);
                    number.to_be_bytes()
                });
                let numbers: Vec<u8> = numbers.collect();
                out.set_text_matrix(line.matrix(&glyphs[0]));
                out.show(Str(&numbers));
            }
            out.end_text();
        }
    }
}

fn parts(RGBColor(r, g, b): RGBColor) -> [f32; 3] {
    [r, g, b].map(|part| f32::from(part) / 255.0)
}

fn fill_with(out: &mut Content, colour: RGBColor) {
    let [r, g, b] = parts(colour);
    out.set_fill_rgb(r, g, b);
}

fn line(out: &mut Content, path: &[Position]) {
    for (i, &(x, y)) in path.iter().enumerate() {
        match i {
            0 => out.move_to(x as f32, y as f32),
            _ => out.line_to(x as f32, y as f32),
        };
    }
}

fn disc(out: &mut Content, (x, y): Position, r: f32) {
    let (x, y, k) = (x as f32, y as f32, QUARTER * r);
    out.move_to(x + r, y);
    out.cubic_to(x + r, y + k, x + k, y + r, x, y + r);
    out.cubic_to(x - k, y + r, x - r, y + k, x - r, y);
    out.cubic_to(x - r, y - k, x - k, y - r, x, y - r);
    out.cubic_to(x + k, y - r, x + r, y - k, x + r, y);
}

fn compressed(bytes: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, LEVEL)
}

impl Used {
    fn new(bold: bool) -> Used {
        Used {
            typeface: Typeface::new(bold),
            glyphs: GlyphRemapper::new(),
            letters: BTreeMap::new(),
        }
    }

    /// Writes the face, under the first of the references.
    fn write(&self, pdf: &mut Pdf, [font, of_glyphs, descriptor, file, map]: [Ref; 5], name: Name) {
        let (typeface, face) = (&self.typeface, &self.typeface.face);
        let thousandths = |length: i16| (typeface.em(length) * 1000.0) as f32;
        pdf.type0_font(font)
            .base_font(name)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(of_glyphs)
            .to_unicode(map);
        let mut cid = pdf.cid_font(of_glyphs);
        cid.subtype(CidFontType::Type2)
            .base_font(name)
            .system_info(SYSTEM)
            .font_descriptor(descriptor)
            .cid_to_gid_map_predefined(Name(b"Identity"));
        let widths = self.glyphs.remapped_gids().map(|id| {
            let width = typeface.advance(ttf_parser::GlyphId(id));
            (width * 1000.0) as f32
        });
        cid.widths().consecutive(0, widths);
        cid.finish();
        let bounds = face.global_bounding_box();
        pdf.font_descriptor(descriptor)
            .name(name)
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(
                thousandths(bounds.x_min),
                thousandths(bounds.y_min),
                thousandths(bounds.x_max),
                thousandths(bounds.y_max),
            ))
            .italic_angle(0.0)
            .ascent(thousandths(face.ascender()))
            .descent(thousandths(face.descender()))
            .cap_height((typeface.height('H') * 1000.0) as f32)
            .stem_v(STEM)
            .font_file2(file);
        let subset = subsetter::subset(typeface.data, 0, &self.glyphs);
        let subset = subset.expect("the family is well-formed");
        let length = i32::try_from(subset.len()).expect("a subset of a typeface is small");
        let subset = compressed(&subset);
        let mut stream = pdf.stream(file, &subset);
        stream.filter(Filter::FlateDecode);
        stream.pair(Name(b"Length1"), length);
        stream.finish();
        let mut unicode = UnicodeCmap::new(Name(b"Letters"), SYSTEM);
        for (&glyph, &letter) in &self.letters {
            unicode.pair(glyph, letter);
        }
        pdf.cmap(map, &unicode.finish());
    }
}

/// Width of vertical stems, in thousandths of an em, for viewers that replace the face; none does, as it is inside.
const STEM: f32 = 80.0;

#[cfg(test)]
mod tests {
    use super::super::canvas::{Anchor, Font, picture};
    use super::super::marked::{END_SUB, SUB};
    use super::*;

    const INK: RGBColor = RGBColor(0, 0, 0);

    /// The content of a page as text.
    fn content(picture: &Picture) -> String {
        let file = picture.pdf();
        let place = |of: &[u8], from: usize| {
            let mut windows = file[from..].windows(of.len());
            from + windows.position(|window| window == of).unwrap()
        };
        let start = place(b"stream\n", 0) + b"stream\n".len();
        let end = place(b"\nendstream", start);
        let content = miniz_oxide::inflate::decompress_to_vec_zlib(&file[start..end]).unwrap();
        String::from_utf8_lossy(&content).into_owned()
    }

    #[test]
    fn lines_areas_and_discs_have_the_places_of_the_picture() {
        let picture = picture(40.0, 20.0, |canvas| {
            canvas.line([(1.0, 2.0), (3.0, 4.5)], 0.7, INK);
            canvas.polygon([(0.0, 0.0), (5.0, 0.0), (5.0, 5.0)], INK);
            canvas.disc((20.0, 10.0), 2.0, INK);
        });
        let drawn = content(&picture);
        for part in [
            "0.075 0 0 -0.075 0 15 cm",
            "0 0 400 200 re\nf",
            "7 w\n10 20 m\n30 45 l\nS",
            "0 0 m\n50 0 l\n50 50 l\nh\nf",
            "220 100 m",
        ] {
            assert!(drawn.contains(part), "{part} in {drawn}");
        }
    }

    #[test]
    fn texts_can_be_read_back() {
        let font = Font {
            size: 10.0,
            colour: INK,
            bold: false,
        };
        let picture = picture(40.0, 20.0, |canvas| {
            let text = format!("θ{SUB}I{END_SUB} (m)");
            canvas.text(&text, (1.0, 2.0), Anchor::Left, font);
        });
        let mut faces = [false, true].map(Used::new);
        picture.content(&mut faces);
        let letters: String = faces[0].letters.values().collect();
        assert_eq!(letters, "θI (m)");
        assert!(faces[1].letters.is_empty());
        let file = picture.pdf();
        assert!(file.starts_with(b"%PDF-1.") && file.trim_ascii_end().ends_with(b"%%EOF"));
        let text = String::from_utf8_lossy(&file);
        assert!(
            text.contains("<0001> <03B8>") && text.contains("DALEMB+DejaVuSans"),
            "{text}"
        );
        assert!(
            !text.contains("DejaVuSans-Bold"),
            "a face that is not used is in the file"
        );
        // A subset, not the 757 kB of the face.
        assert!(file.len() < 20_000, "{} bytes", file.len());
    }
}
