//! Stick-slip of a spring slider, `K (V_l - V) = d/dt [a p asinh(...) + eta V]`, as an ordinary differential equation in
//! `ln(V / V_0)` and `ln(V_0 theta / D_c)`, integrated by the embedded pair of Dormand and Prince with an error of 1e-9 a
//! step. It shares no line with the law of the interface.

/// Numbers of the gouge and of the slider; SI units.
pub struct Slider {
    pub pressure: f64,
    pub friction: f64,
    pub direct: f64,
    pub evolution: f64,
    pub distance: f64,
    /// Of reference and of the load.
    pub velocity: f64,
    pub stiffness: f64,
    /// Radiation damping.
    pub damping: f64,
    /// Whether the state ages; else it changes by slip only.
    pub ageing: bool,
}

const NODES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
const TOLERANCE: f64 = 1e-9;

impl Slider {
    fn rate(&self, [speed, state]: [f64; 2]) -> [f64; 2] {
        let v = self.velocity * speed.exp();
        let level = speed - std::f64::consts::LN_2 + (self.friction + self.evolution * state) / self.direct;
        let slope = 1.0 / (1.0 + (-2.0 * level).exp()).sqrt();
        let change = if self.ageing { self.velocity * (-state).exp() - v } else { -v * (speed + state) };
        let aged = change / self.distance;
        let load = self.stiffness * (self.velocity - v) - self.evolution * self.pressure * slope * aged;
        [load / (self.direct * self.pressure * slope + self.damping * v), aged]
    }

    /// The time between the last two jumps, of those that begin up to a time: a thousand times the velocity of the load.
    pub fn period(&self, end: f64) -> f64 {
        let (mut time, mut y, mut h) = (0.0, [0.01, 0.0], 1e-3);
        let (threshold, mut jumps) = (1e3_f64.ln(), Vec::new());
        while time < end {
            let mut rates = vec![self.rate(y)];
            let mut next = y;
            for row in NODES {
                next = std::array::from_fn(|i| y[i] + h * row.iter().zip(&rates).map(|(c, k)| c * k[i]).sum::<f64>());
                rates.push(self.rate(next));
            }
            let off = |i: usize| (h * ERROR.iter().zip(&rates).map(|(c, k)| c * k[i]).sum::<f64>()).abs();
            let error = off(0).max(off(1)) / TOLERANCE;
            if !error.is_finite() {
                h *= 0.1;
                continue;
            }
            if error <= 1.0 {
                if y[0] < threshold && next[0] >= threshold {
                    jumps.push(time + h * (threshold - y[0]) / (next[0] - y[0]));
                }
                (time, y) = (time + h, next);
            }
            h *= (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0);
        }
        if let [.., before, last] = jumps[..] { last - before } else { f64::NAN }
    }
}
