//! Marks on an axis at round numbers, and how these are written.

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By powers of ten.
    Log,
}

/// Marks of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Ticks {
    /// Ends of the axis.
    pub range: [f64; 2],
    /// Marks with their labels.
    pub major: Vec<(f64, String)>,
    /// Marks without labels.
    pub minor: Vec<f64>,
    /// Power of ten that all labels of the axis leave out.
    pub exponent: i32,
}

/// The round number (1, 2 or 5 times a power of ten) next above `x`.
pub fn round_up(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= x * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// The round number next below `x`.
pub fn round_down(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|f| f * power <= x * (1.0 + 1e-9));
    factor.unwrap_or(1.0) * power
}

/// About `count` marks within `range`. With `widen` the ends move out to marks.
pub fn ticks(scale: Scale, range: [f64; 2], count: usize, widen: bool) -> Ticks {
    match scale {
        Scale::Linear => linear(sound(range), count, widen),
        Scale::Log => log(range, count),
    }
}

/// A range with some length, whatever the data are.
fn sound([low, high]: [f64; 2]) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite()) {
        return [0.0, 1.0];
    }
    let least = 1e-9 * low.abs().max(high.abs());
    match high - low {
        span if span > least => [low, high],
        _ if least > 0.0 => [low - 0.5 * low.abs(), high + 0.5 * high.abs()],
        _ => [0.0, 1.0],
    }
}

fn linear([mut low, mut high]: [f64; 2], count: usize, widen: bool) -> Ticks {
    let step = round_up((high - low) / count.max(1) as f64);
    if widen {
        (low, high) = ((low / step + 1e-9).floor() * step, (high / step - 1e-9).ceil() * step);
    }
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    let exponent = common_exponent(low.abs().max(high.abs()));
    let label = |i: i64| (i as f64 * step, decimal(i as f64 * step, step, exponent));
    Ticks { range: [low, high], major: (first..=last).map(label).collect(), minor: Vec::new(), exponent }
}

/// Numbers of up to five digits before or two zeros behind the point are written as they are.
fn common_exponent(largest: f64) -> i32 {
    let power = largest.log10().floor() as i32;
    if (-2..5).contains(&power) { 0 } else { power.div_euclid(3) * 3 }
}

/// A multiple of `step` in units of a power of ten, with the digits that the step needs.
fn decimal(value: f64, step: f64, exponent: i32) -> String {
    let unit = 10f64.powi(exponent);
    let digits = (-(step / unit * (1.0 + 1e-9)).log10().floor()).max(0.0) as usize;
    minus(&format!("{:.digits$}", value / unit + 0.0))
}

/// A number to about three digits, for legends; powers of ten raised.
pub fn short(value: f64) -> String {
    let power = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    if (-3..5).contains(&power) {
        let digits = (2 - power).clamp(0, 5) as usize;
        let text = format!("{value:.digits$}");
        let short = if digits > 0 { text.trim_end_matches('0').trim_end_matches('.') } else { text.as_str() };
        return minus(short);
    }
    let factor = value / 10f64.powi(power);
    let text = format!("{factor:.2}");
    minus(&format!("{} · 10^{{{power}}}", text.trim_end_matches('0').trim_end_matches('.')))
}

/// The mark of print for a negative number.
pub fn minus(text: &str) -> String {
    text.replace('-', "−")
}

fn log([low, high]: [f64; 2], count: usize) -> Ticks {
    let sound = |x: f64| x.is_finite() && x > 0.0;
    let (low, high) = if sound(low) && sound(high) { (low, high) } else { (0.1, 1.0) };
    let first = (low.log10() + 1e-9).floor() as i32;
    let last = ((high.log10() - 1e-9).ceil() as i32).max(first + 1);
    let stride = ((last - first) as usize).div_ceil(count.max(1)).max(1);
    let power = |i: i32| 10f64.powi(i);
    let major = (first..=last).step_by(stride).map(|i| (power(i), minus(&format!("10^{{{i}}}")))).collect();
    let inner = |i: i32| (2..10).map(move |k| f64::from(k) * power(i));
    let minor = if stride == 1 && last - first <= 6 {
        (first..last).flat_map(inner).collect()
    } else {
        (first..=last).map(power).collect()
    };
    Ticks { range: [power(first), power(last)], major, minor, exponent: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn marks_are_round() {
        let t = ticks(Scale::Linear, [0.0, 97.0], 5, true);
        assert_eq!((labels(&t), t.range), (vec!["0", "20", "40", "60", "80", "100"], [0.0, 100.0]));
        let t = ticks(Scale::Linear, [-0.31, 0.42], 4, false);
        assert_eq!((labels(&t), t.range), (vec!["−0.2", "0.0", "0.2", "0.4"], [-0.31, 0.42]));
        let t = ticks(Scale::Linear, [0.0, 1.2e6], 4, true);
        assert_eq!((labels(&t), t.exponent), (vec!["0.0", "0.5", "1.0", "1.5"], 6));
        let t = ticks(Scale::Linear, [0.0, 3e-4], 3, true);
        assert_eq!((labels(&t), t.exponent), (vec!["0", "100", "200", "300"], -6));
    }

    #[test]
    fn powers_of_ten_do_not_crowd() {
        let t = ticks(Scale::Log, [3e-13, 2.0], 7, true);
        assert_eq!(t.range, [1e-13, 10.0]);
        assert!(t.major.len() <= 8, "{:?}", labels(&t));
        let t = ticks(Scale::Log, [0.5, 50.0], 5, true);
        assert_eq!((labels(&t), t.minor.len()), (vec!["10^{−1}", "10^{0}", "10^{1}", "10^{2}"], 24));
    }

    #[test]
    fn any_data_give_an_axis() {
        for range in [[0.0, 0.0], [5.0, 5.0], [f64::NAN, 1.0], [f64::INFINITY, f64::NEG_INFINITY], [-2.0, -2.0]] {
            for scale in [Scale::Linear, Scale::Log] {
                let t = ticks(scale, range, 5, true);
                assert!(t.range[1] > t.range[0] && t.major.len() > 1 && t.major.len() < 20, "{range:?} {t:?}");
            }
        }
    }

    #[test]
    fn numbers_in_legends_are_short() {
        let texts: Vec<_> = [0.0, 194.017, -0.0125, 1_234_567.0, 2e-9, 500.0].into_iter().map(short).collect();
        assert_eq!(texts, ["0", "194", "−0.0125", "1.23 · 10^{6}", "2 · 10^{−9}", "500"]);
    }

    #[test]
    fn rounding_goes_the_way_it_says() {
        for x in [0.07, 1.0, 1.9, 3.0, 4999.0, 5000.0] {
            assert!(round_down(x) <= x * (1.0 + 1e-8) && round_up(x) >= x * (1.0 - 1e-8));
            assert!(round_up(x) / round_down(x) < 2.6);
        }
    }
}
