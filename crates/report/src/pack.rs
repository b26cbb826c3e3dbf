//! Numbers as text of a page. Values are quantised over their range, predicted from their neighbours in the array and in the
//! frame before, laid down by planes of bytes, deflated, and written in base64; `assets/pack.js` undoes it.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use std::io::Write;

/// A packed array of the page; its values belong to frames, one after another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Packed {
    /// The text; empty where all values are `low`.
    #[serde(skip)]
    pub text: String,
    /// Which of the page's texts holds the values; none where all are `low`.
    pub blob: Option<usize>,
    /// Bytes a number.
    pub planes: usize,
    /// Prediction: 0 from the value before, 1 from the frame before, 2 from both.
    pub predictor: u8,
    /// Least and greatest value; of whole numbers 0 and the greatest.
    pub low: f64,
    /// See `low`.
    pub high: f64,
    /// The code of the greatest value; the next one stands for what is no finite number.
    pub steps: u32,
}

/// The texts of a page.
#[derive(Debug, Clone, Default)]
pub struct Blobs(pub Vec<String>);

impl Blobs {
    /// Takes the text of an array.
    pub fn take(&mut self, mut packed: Packed) -> Packed {
        if !packed.text.is_empty() {
            packed.blob = Some(self.0.len());
            self.0.push(std::mem::take(&mut packed.text));
        }
        packed
    }
    /// Characters of all texts.
    pub fn size(&self) -> usize {
        self.0.iter().map(String::len).sum()
    }
}

/// Whole numbers, as connectivity.
pub fn whole(values: &[u32]) -> Packed {
    let greatest = values.iter().copied().max().unwrap_or(0);
    let planes = planes(u64::from(greatest) * 2 + 1);
    let text = text(&residuals(values, &[values.len()], 0), planes);
    let high = f64::from(greatest);
    Packed { text, blob: None, planes, predictor: 0, low: 0.0, high, steps: greatest }
}

/// Real values of several frames of `counts` values each, in `2^bits` steps over their range.
pub fn real(values: &[f32], counts: &[usize], bits: u32) -> Packed {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    let [low, high] = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
    let [low, high] = if low <= high { [f64::from(low), f64::from(high)] } else { [0.0; 2] };
    let steps = (1u32 << bits) - 2;
    let all = values.iter().all(|value| value.is_finite());
    if all && low == high {
        return Packed { text: String::new(), blob: None, planes: 0, predictor: 0, low, high, steps };
    }
    let scale = if high > low { f64::from(steps) / (high - low) } else { 0.0 };
    let code = |&value: &f32| match value.is_finite() {
        // A cast of a number in range: between 0 and `steps`.
        true => ((f64::from(value) - low) * scale).round() as u32,
        false => steps + 1,
    };
    let codes: Vec<u32> = values.iter().map(code).collect();
    let equal = counts.windows(2).all(|pair| pair[0] == pair[1]) && counts.len() > 1;
    let predictors = if equal { 0..3 } else { 0..1 };
    let tried = predictors.map(|predictor| (predictor, residuals(&codes, counts, predictor)));
    let cost = |residuals: &[u32]| residuals.iter().map(|r| u64::from((r + 1).ilog2())).sum::<u64>();
    let best = tried.min_by_key(|(_, residuals)| cost(residuals));
    let (predictor, residuals) = best.unwrap_or_default();
    // Prediction from both can miss by twice the range, and a sign comes on top.
    let planes = planes(u64::from(steps + 1) * 4 + 1);
    Packed { text: text(&residuals, planes), blob: None, planes, predictor, low, high, steps }
}

/// Bytes for a number up to `greatest`.
fn planes(greatest: u64) -> usize {
    (64 - greatest.leading_zeros()).div_ceil(8) as usize
}

/// What the prediction leaves, with its sign in the lowest bit.
fn residuals(codes: &[u32], counts: &[usize], predictor: u8) -> Vec<u32> {
    let mut out = Vec::with_capacity(codes.len());
    let mut first = 0;
    for (frame, &count) in counts.iter().enumerate() {
        let now = codes.get(first..first + count).unwrap_or(&[]);
        let before = if frame > 0 && predictor > 0 { &codes[first - count..first] } else { &[] };
        for (i, &code) in now.iter().enumerate() {
            let left = if i > 0 { i64::from(now[i - 1]) } else { 0 };
            let guess = match (before.get(i), predictor) {
                (None, _) => left,
                (Some(&old), 1) => i64::from(old),
                (Some(&old), _) => i64::from(old) + left - if i > 0 { i64::from(before[i - 1]) } else { 0 },
            };
            let rest = i64::from(code) - guess;
            // Codes are below 2^24, so that no residual leaves 32 bits.
            out.push(((rest << 1) ^ (rest >> 63)) as u32);
        }
        first += count;
    }
    out
}

fn text(residuals: &[u32], planes: usize) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(6));
    let written = (0..planes).try_for_each(|plane| {
        let bytes: Vec<u8> = residuals.iter().map(|residual| (residual >> (8 * plane)) as u8).collect();
        encoder.write_all(&bytes)
    });
    // Writing into memory cannot fail.
    let bytes = written.and_then(|()| encoder.finish()).unwrap_or_default();
    STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    /// What the script of the page does.
    fn unpacked(packed: &Packed, counts: &[usize]) -> Vec<f64> {
        let total: usize = counts.iter().sum();
        if packed.text.is_empty() {
            return vec![packed.low; total];
        }
        let mut bytes = Vec::new();
        let deflated = STANDARD.decode(&packed.text).unwrap();
        flate2::read::ZlibDecoder::new(&deflated[..]).read_to_end(&mut bytes).unwrap();
        let residual = |i: usize| (0..packed.planes).map(|p| i64::from(bytes[p * total + i]) << (8 * p)).sum::<i64>();
        let (mut codes, mut first) = (vec![0i64; total], 0);
        for (frame, &count) in counts.iter().enumerate() {
            for i in first..first + count {
                let left = if i > first { codes[i - 1] } else { 0 };
                let guess = match packed.predictor {
                    0 => left,
                    _ if frame == 0 => left,
                    1 => codes[i - count],
                    _ => codes[i - count] + left - if i > first { codes[i - 1 - count] } else { 0 },
                };
                let zigzag = residual(i);
                codes[i] = guess + ((zigzag >> 1) ^ -(zigzag & 1));
            }
            first += count;
        }
        let step = (packed.high - packed.low) / f64::from(packed.steps.max(1));
        let value =
            |&code: &i64| if code > i64::from(packed.steps) { f64::NAN } else { packed.low + step * code as f64 };
        codes.iter().map(value).collect()
    }

    #[test]
    fn values_come_back_within_half_a_step() {
        for (frames, bits) in [(1, 16), (5, 20), (5, 8)] {
            let value = |i: usize| (0.01 * (i % 700) as f32).sin() * (1.0 + (i / 700) as f32) + 3.0;
            let values: Vec<f32> = (0..700 * frames).map(value).collect();
            let counts = vec![700; frames];
            let packed = real(&values, &counts, bits);
            let step = (packed.high - packed.low) / f64::from(packed.steps);
            let back = unpacked(&packed, &counts);
            let error = values.iter().zip(&back).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
            assert!(error <= 0.51 * step, "{error} {step}");
        }
    }

    #[test]
    fn frames_of_different_lengths_holes_and_constants_come_back() {
        let values = [1.0, f32::NAN, 3.0, 4.0, 5.0, f32::INFINITY];
        let packed = real(&values, &[2, 1, 3], 16);
        let back = unpacked(&packed, &[2, 1, 3]);
        assert!(back[1].is_nan() && back[5].is_nan() && (back[2] - 3.0).abs() < 1e-4);
        let constant = real(&[7.0; 9], &[3; 3], 16);
        assert!(constant.text.is_empty() && unpacked(&constant, &[3; 3]) == [7.0; 9]);
        assert!(real(&[], &[0], 16).text.is_empty());
        assert!(unpacked(&real(&[f32::NAN; 3], &[3], 16), &[3]).iter().all(|x| x.is_nan()));
    }

    #[test]
    fn whole_numbers_come_back() {
        let values = [5, 0, 70_000, 70_001, 3];
        assert_eq!(unpacked(&whole(&values), &[5]), values.map(f64::from));
    }
}
