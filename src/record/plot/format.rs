//! Formats of pictures.

use super::canvas::Picture;

/// A format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Scalable, for browsers and pages.
    Svg,
    /// Pixels, two on one of the picture's.
    #[cfg(feature = "png-pdf")]
    Png,
    /// Scalable, for papers; a pixel of the picture is 0.75 pt.
    #[cfg(feature = "png-pdf")]
    Pdf,
}

impl Format {
    /// All formats that this build has.
    pub const ALL: &[Format] = &[
        Format::Svg,
        #[cfg(feature = "png-pdf")]
        Format::Png,
        #[cfg(feature = "png-pdf")]
        Format::Pdf,
    ];

    /// Whether a picture of this width and height, px, has room in a file of it.
    pub fn has_room(self, size: (f64, f64)) -> bool {
        match self {
            #[cfg(feature = "png-pdf")]
            Format::Png => super::png::has_room(size),
            _ => size.0.is_finite() && size.1.is_finite(),
        }
    }

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Format::Svg => "svg",
            #[cfg(feature = "png-pdf")]
            Format::Png => "png",
            #[cfg(feature = "png-pdf")]
            Format::Pdf => "pdf",
        }
    }
}

impl Picture {
    /// The picture as a file of this format.
    pub fn file(&self, format: Format) -> Vec<u8> {
        match format {
            Format::Svg => self.svg().into_bytes(),
            #[cfg(feature = "png-pdf")]
            Format::Png => self.png(),
            #[cfg(feature = "png-pdf")]
            Format::Pdf => self.pdf(),
        }
    }
}
