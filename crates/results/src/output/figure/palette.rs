//! Colours that eyes of all kinds tell apart. Lines: the eight of Okabe and Ito (2008), less the yellow that white paper
//! swallows. Fields: a path through OKLCh (Ottosson 2020) on which lightness falls evenly, so that it reads in grey too.

/// A colour in sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Color(pub [u8; 3]);

impl Color {
    /// Black.
    pub const BLACK: Self = Self([0, 0, 0]);
    /// White.
    pub const WHITE: Self = Self([255, 255, 255]);
    /// Lines that should stay in the background.
    pub const GREY: Self = Self([130, 130, 130]);
    /// Lines of a grid.
    pub const PALE: Self = Self([226, 226, 226]);
    /// The inside of a body.
    pub const BODY: Self = Self([233, 238, 244]);
    /// The edges of its cells.
    pub const CELLS: Self = Self([112, 128, 144]);
    /// The arrows of contact stress.
    pub const ARROW: Self = Self([0xD5, 0x5E, 0x00]);
    /// The same behind a body.
    pub const HIDDEN_ARROW: Self = Self([0xEF, 0xC6, 0xA6]);
}

const LINES: [Color; 7] = [
    Color([0x00, 0x72, 0xB2]),
    Color([0xD5, 0x5E, 0x00]),
    Color([0x00, 0x9E, 0x73]),
    Color([0xCC, 0x79, 0xA7]),
    Color([0x00, 0x00, 0x00]),
    Color([0xE6, 0x9F, 0x00]),
    Color([0x56, 0xB4, 0xE9]),
];

const DASHES: [&[f64]; 4] = [&[], &[6.0, 3.0], &[1.5, 2.5], &[7.0, 2.5, 1.5, 2.5]];

/// Colour of the line number `index`; they come round after seven.
pub fn line(index: usize) -> Color {
    LINES[index % LINES.len()]
}

/// Dashes of the line number `index`, so that lines differ without their colours.
pub fn dash(index: usize) -> &'static [f64] {
    DASHES[index % DASHES.len()]
}

/// Colour of a field at `t` between 0 (light) and 1 (dark).
pub fn field(t: f64) -> Color {
    let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
    let lightness = 0.96 - 0.64 * t;
    let chroma = 0.05 + 0.055 * (std::f64::consts::PI * t).sin();
    let hue = (105.0 + 165.0 * t).to_radians();
    from_oklab([lightness, chroma * hue.cos(), chroma * hue.sin()])
}

fn from_oklab([l, a, b]: [f64; 3]) -> Color {
    let cube = |x: f64| x * x * x;
    let long = cube(l + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let middle = cube(l - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let short = cube(l - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    let linear = [
        4.076_741_662_1 * long - 3.307_711_591_3 * middle + 0.230_969_929_2 * short,
        -1.268_438_004_6 * long + 2.609_757_401_1 * middle - 0.341_319_396_5 * short,
        -0.004_196_086_3 * long - 0.703_418_614_7 * middle + 1.707_614_701_0 * short,
    ];
    Color(linear.map(|x| (255.0 * gamma(x.clamp(0.0, 1.0))).round() as u8))
}

fn gamma(x: f64) -> f64 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(color: Color) -> f64 {
        let linear = color.0.map(|c| (f64::from(c) / 255.0).powf(2.2));
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    #[test]
    fn a_field_reads_in_grey() {
        let steps: Vec<f64> = (0..=50).map(|i| luminance(field(f64::from(i) / 50.0))).collect();
        assert!(steps.windows(2).all(|w| w[1] < w[0]), "{steps:?}");
        assert!(steps[0] > 0.8 && steps[50] < 0.1);
    }

    #[test]
    fn what_is_no_number_has_a_colour() {
        assert_eq!(field(f64::NAN), field(0.0));
        assert_eq!(field(7.0), field(1.0));
    }
}
