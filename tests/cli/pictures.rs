//! The same picture in all formats: SVG in a browser and PDF by Poppler, where they are there, are the PNG, pixel by pixel.

use super::browser::{browser, screenshot};
use super::*;
use std::process::Command as Program;

/// Pixels of a picture.
struct Pixels {
    width: usize,
    rgb: Vec<[u8; 3]>,
}

impl Pixels {
    fn read(path: &Path) -> Pixels {
        let file = std::io::BufReader::new(fs::File::open(path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        let pixels = bytes[..info.buffer_size()].chunks_exact(info.color_type.samples());
        Pixels {
            width: info.width as usize,
            rgb: pixels.map(|p| [p[0], p[1], p[2]]).collect(),
        }
    }

    /// The picture, further to the right.
    fn moved(&self, by: usize) -> Pixels {
        let mut rgb = self.rgb.clone();
        rgb.rotate_right(by);
        Pixels { rgb, ..*self }
    }

    /// How many of the pixels that count, and how many of them have no like within a pixel of the picture, which has two of these.
    fn missing_in(&self, other: &Pixels, counts: impl Fn([u8; 3]) -> bool) -> [usize; 2] {
        assert_eq!((self.width, self.rgb.len()), (other.width, other.rgb.len()));
        let (width, height) = (self.width as i64, (self.rgb.len() / self.width) as i64);
        let mut found = [0, 0];
        for (i, &pixel) in self.rgb.iter().enumerate() {
            if !counts(pixel) {
                continue;
            }
            let (x, y) = (i as i64 % width, i as i64 / width);
            let beside = (-2..=2).flat_map(|dy| (-2..=2).map(move |dx| (x + dx, y + dy)));
            let mut beside =
                beside.filter(|&(x, y)| (0..width).contains(&x) && (0..height).contains(&y));
            let is_like =
                |(x, y): (i64, i64)| distance(pixel, other.rgb[(y * width + x) as usize]) <= LIKE;
            found[0] += 1;
            found[1] += usize::from(!beside.any(is_like));
        }
        found
    }
}

/// Edges are mixed of a colour and what is behind it, by each program in its way: a mixture differs from the nearer of both by at
/// most half of all shades.
const LIKE: i32 = 128;

/// The largest difference of two colours in red, green or blue.
fn distance(a: [u8; 3], b: [u8; 3]) -> i32 {
    let differences = (0..3).map(|k| (i32::from(a[k]) - i32::from(b[k])).abs());
    differences.max().unwrap()
}

/// Curves and bands have a colour, letters and axes are grey.
fn is_coloured(pixel: [u8; 3]) -> bool {
    let [least, most] = [pixel.iter().min().unwrap(), pixel.iter().max().unwrap()];
    most - least > 60
}

fn is_dark(pixel: [u8; 3]) -> bool {
    pixel.iter().all(|&shade| shade < 128)
}

#[test]
fn svg_png_and_pdf_are_the_same_picture() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("out");
    let of = scene("tank_rocks_and_slides");
    let more = ["--set", "end=0.6", "--plot-format", "svg,png,pdf"];
    ends_with(
        0,
        home.path(),
        &[&["run", &of, "--out", "out"][..], &more].concat(),
    );
    for name in ["overview", "phase"] {
        let png = Pixels::read(&out.join(format!("{name}.png")));
        // What is moved by more than a pixel is not the same.
        let [_, missing] = png.missing_in(&png.moved(4), is_coloured);
        assert!(missing > 0);
        if let Some(pdf) = of_pdf(&out.join(format!("{name}.pdf"))) {
            // The same letters at the same places, too.
            for [all, missing] in [png.missing_in(&pdf, is_dark), pdf.missing_in(&png, is_dark)] {
                assert!(all > 1000 && missing == 0, "{name}: {missing} of {all}");
            }
            compare(name, &png, &pdf);
        }
        let svg = out.join(format!("{name}.svg"));
        if browser().is_some() {
            let size = (png.width / 2, png.rgb.len() / png.width / 2);
            let shown = out.join("shown.png");
            screenshot(&svg, &shown, size);
            compare(name, &png, &Pixels::read(&shown));
        }
    }
}

/// What has a colour in one has it in the other.
fn compare(name: &str, a: &Pixels, b: &Pixels) {
    for [all, missing] in [a.missing_in(b, is_coloured), b.missing_in(a, is_coloured)] {
        assert!(all > 1000 && missing == 0, "{name}: {missing} of {all}");
    }
}

/// The first page of a PDF, two pixels on each of the picture's, which is 0.75 pt.
fn of_pdf(path: &Path) -> Option<Pixels> {
    let shown = path.with_extension("shown");
    let converted = Program::new("pdftoppm")
        .args(["-r", "192", "-png", "-singlefile"])
        .args([path, &shown])
        .status();
    match converted {
        Ok(status) => assert!(status.success()),
        Err(_) => {
            eprintln!("left out: no pdftoppm on this machine");
            return None;
        }
    }
    Some(Pixels::read(&shown.with_extension("shown.png")))
}
