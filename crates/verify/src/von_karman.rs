//! Rolling of a rigid, perfectly plastic strip between rigid rolls with plane sections (T. von Karman 1925). With `2k = 1`
//! the tension of a section `T = h (p - 1)` obeys `dT/da = 2 R p (sin a +- mu cos a)` over the angle `a` to the line
//! through the axes of the rolls, from `T = 0` at both ends; the lesser of the two pressures holds.

/// A pass: thickness before and after, radius of the rolls and friction.
#[derive(Debug, Clone, Copy)]
pub struct Gap {
    /// Thickness before and after.
    pub thickness: [f64; 2],
    /// Radius of the rolls.
    pub radius: f64,
    /// Coefficient of friction.
    pub friction: f64,
}

/// What the theory says.
pub struct Theory {
    /// Angle in radians and pressure over `2k`, from the exit to the entry.
    pub pressure: Vec<[f64; 2]>,
    /// Angle at which friction turns, in radians.
    pub neutral: f64,
    /// Force along the line through the axes per unit of width, over `2k`.
    pub force: f64,
}

/// Parts of the arc for Runge and Kutta's method.
const PARTS: usize = 2000;

impl Gap {
    /// The arc of contact, in radians.
    pub fn arc(&self) -> f64 {
        (1.0 - 0.5 * (self.thickness[0] - self.thickness[1]) / self.radius).acos()
    }

    fn thickness_at(&self, angle: f64) -> f64 {
        self.thickness[1] + 2.0 * self.radius * (1.0 - angle.cos())
    }

    fn slope(&self, angle: f64, tension: f64, sign: f64) -> f64 {
        let pressure = 1.0 + tension / self.thickness_at(angle);
        2.0 * self.radius * pressure * (angle.sin() + sign * self.friction * angle.cos())
    }

    /// Pressure at equal angles, from no tension at the first.
    fn branch(&self, from: f64, to: f64, sign: f64) -> Vec<[f64; 2]> {
        let step = (to - from) / PARTS as f64;
        let (mut tension, mut curve) = (0.0, vec![[from, 1.0]]);
        for i in 0..PARTS {
            let a = from + step * i as f64;
            let k1 = self.slope(a, tension, sign);
            let k2 = self.slope(a + 0.5 * step, tension + 0.5 * step * k1, sign);
            let k3 = self.slope(a + 0.5 * step, tension + 0.5 * step * k2, sign);
            let k4 = self.slope(a + step, tension + step * k3, sign);
            tension += step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            curve.push([a + step, 1.0 + tension / self.thickness_at(a + step)]);
        }
        curve
    }

    /// The theory of this pass.
    pub fn theory(&self) -> Theory {
        let (exit, mut entry) = (self.branch(0.0, self.arc(), 1.0), self.branch(self.arc(), 0.0, -1.0));
        entry.reverse();
        let neutral = exit.iter().zip(&entry).find(|(a, b)| a[1] >= b[1]).map_or(f64::NAN, |(a, _)| a[0]);
        let pressure: Vec<_> = exit.iter().zip(&entry).map(|(a, b)| [a[0], a[1].min(b[1])]).collect();
        // Friction draws the strip in behind the neutral angle and holds it back before, which loads the roll and relieves it.
        let upright = |&[angle, pressure]: &[f64; 2]| {
            let sign = if angle > neutral { 1.0 } else { -1.0 };
            pressure * (angle.cos() + sign * self.friction * angle.sin())
        };
        let mean =
            pressure.windows(2).map(|two| 0.5 * (upright(&two[0]) + upright(&two[1]))).sum::<f64>() / PARTS as f64;
        Theory { pressure, neutral, force: mean * self.radius * self.arc() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force, largest pressure and neutral angle in degrees of four passes, by another program.
    #[test]
    fn four_passes() {
        for (thickness, radius, friction, wanted) in [
            ([2.0, 1.6], 65.0, 0.1, [5.5950, 1.2352, 1.361]),
            ([2.0, 1.4], 65.0, 0.1, [6.8952, 1.2868, 1.422]),
            ([10.0, 8.0], 100.0, 0.2, [15.907, 1.2798, 2.601]),
            ([10.0, 7.0], 100.0, 0.3, [22.687, 1.7264, 3.471]),
        ] {
            let theory = Gap { thickness, radius, friction }.theory();
            let largest = theory.pressure.iter().fold(0.0, |m: f64, p| m.max(p[1]));
            let found = [theory.force, largest, theory.neutral.to_degrees()];
            assert!(found.iter().zip(wanted).all(|(a, b)| (a / b - 1.0).abs() < 2e-3), "{found:?} for {wanted:?}");
        }
    }
}
