//! The arguments of a UMAT, in their order.

use asperity_core::material::external::Call;
use asperity_core::tensor::Tensor2;

/// A UMAT: 37 addresses and the length of CMNAME, which Fortran appends.
pub type Function = unsafe extern "C-unwind" fn(
    stress: *mut f64,
    statev: *mut f64,
    ddsdde: *mut f64,
    sse: *mut f64,
    spd: *mut f64,
    scd: *mut f64,
    rpl: *mut f64,
    ddsddt: *mut f64,
    drplde: *mut f64,
    drpldt: *mut f64,
    stran: *const f64,
    dstran: *const f64,
    time: *const f64,
    dtime: *const f64,
    temp: *const f64,
    dtemp: *const f64,
    predef: *const f64,
    dpred: *const f64,
    cmname: *const u8,
    ndi: *const i32,
    nshr: *const i32,
    ntens: *const i32,
    nstatv: *const i32,
    props: *const f64,
    nprops: *const i32,
    coords: *const f64,
    drot: *const f64,
    pnewdt: *mut f64,
    celent: *const f64,
    dfgrd0: *const f64,
    dfgrd1: *const f64,
    noel: *const i32,
    npt: *const i32,
    layer: *const i32,
    kspt: *const i32,
    jstep: *const i32,
    kinc: *const i32,
    length: usize,
);

/// What stands behind the states and the tangent, which no law computes.
pub const UNTOUCHED: f64 = -9.870_654_321e299;

/// What a law finds in PNEWDT: more than anybody asks for.
const LARGE: f64 = 1e36;

/// The values behind the addresses. The law gets copies, so that what it writes where it should not is lost.
pub struct Arguments<'a> {
    stress: [f64; 6],
    states: &'a mut [f64],
    tangent: [f64; 36],
    energies: [f64; 3],
    /// RPL and DRPLDT, then DDSDDT and DRPLDE: heat, of which there is none.
    heat: [f64; 14],
    strain: [[f64; 6]; 2],
    /// That of the step and that of the run, which are one.
    time: [f64; 2],
    dt: f64,
    /// TEMP, DTEMP, and PREDEF and DPRED: no other fields.
    fields: [f64; 4],
    name: &'a [u8; 80],
    properties: &'a [f64],
    place: [f64; 3],
    rotation: [f64; 9],
    /// PNEWDT.
    pub new_time: f64,
    length: f64,
    deformation: [[f64; 9]; 2],
    /// NDI, NSHR, NTENS, NSTATV, NPROPS, NOEL, NPT, LAYER, KSPT, KINC.
    whole: [i32; 10],
    /// Number of the step, kind of procedure, large deformations or not, perturbation or not.
    step: [i32; 4],
}

/// A count as Fortran takes it; no model has so many that it would be another.
fn whole(count: usize) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX)
}

/// Column by column.
fn columns(t: &Tensor2) -> [f64; 9] {
    std::array::from_fn(|k| t[(k % 3, k / 3)])
}

impl<'a> Arguments<'a> {
    /// Those of a call, with `states` in the place of its own and room behind them.
    pub fn of(call: &Call, states: &'a mut [f64], name: &'a [u8; 80], properties: &'a [f64]) -> Self {
        let at = &call.at;
        let (cell, point) = (usize::try_from(at.cell).unwrap_or(usize::MAX), at.point);
        let counts = [3, call.components - 3, call.components, call.states.len(), properties.len(), cell, point];
        let mut all = [1; 10];
        all.iter_mut().zip(counts.map(whole)).for_each(|(value, count)| *value = count);
        all[9] = whole(call.number);
        Self {
            stress: call.stress,
            tangent: std::array::from_fn(|k| if k < call.components.pow(2) { 0.0 } else { UNTOUCHED }),
            energies: call.energies,
            heat: [0.0; 14],
            strain: call.strain,
            time: [call.time[0]; 2],
            dt: call.time[1],
            fields: [call.temperature[0], call.temperature[1] - call.temperature[0], 0.0, 0.0],
            name,
            properties,
            place: at.place.0,
            rotation: columns(&call.rotation),
            new_time: LARGE,
            length: at.length,
            deformation: [columns(&call.deformation[0]), columns(&call.deformation[1])],
            whole: all,
            step: [1, 1, i32::from(!call.small), 0],
            states,
        }
    }

    /// What the law wrote beyond its states and its tangent, in words.
    pub fn overrun(&self) -> Option<String> {
        let [components, states] = [self.whole[2], self.whole[3]].map(|count| usize::try_from(count).unwrap_or(0));
        let touched = |rest: &[f64]| rest.iter().any(|value| value.to_bits() != UNTOUCHED.to_bits());
        if touched(&self.states[states..]) {
            return Some(format!("it writes more than {states} states; say in `states` how many it has"));
        }
        let wrong = touched(&self.tangent[components * components..]);
        wrong.then(|| format!("it writes DDSDDE beyond its {components} rows and columns (NTENS)"))
    }

    /// Stress, tangent and energies.
    pub fn answers(&self) -> ([f64; 6], [f64; 36], [f64; 3]) {
        let tangent = self.tangent.map(|value| if value.to_bits() == UNTOUCHED.to_bits() { 0.0 } else { value });
        (self.stress, tangent, self.energies)
    }

    /// Calls the law.
    pub fn call(&mut self, function: Function) {
        let (energies, heat, fields) = (self.energies.as_mut_ptr(), self.heat.as_mut_ptr(), self.fields.as_ptr());
        let at = |i: usize| &raw const self.whole[i];
        // SAFETY: every address is that of as many values as the interface says, which live until the call ends: NTENS of the
        // six, NTENS squared of the 36, NSTATV states, NPROPS properties. What the law does with them is its author's business.
        unsafe {
            function(
                self.stress.as_mut_ptr(),
                self.states.as_mut_ptr(),
                self.tangent.as_mut_ptr(),
                energies,
                energies.add(1),
                energies.add(2),
                heat,
                heat.add(2),
                heat.add(8),
                heat.add(1),
                self.strain[0].as_ptr(),
                self.strain[1].as_ptr(),
                self.time.as_ptr(),
                &raw const self.dt,
                fields,
                fields.add(1),
                fields.add(2),
                fields.add(3),
                self.name.as_ptr(),
                at(0),
                at(1),
                at(2),
                at(3),
                self.properties.as_ptr(),
                at(4),
                self.place.as_ptr(),
                self.rotation.as_ptr(),
                &raw mut self.new_time,
                &raw const self.length,
                self.deformation[0].as_ptr(),
                self.deformation[1].as_ptr(),
                at(5),
                at(6),
                at(7),
                at(8),
                self.step.as_ptr(),
                at(9),
                self.name.len(),
            );
        }
    }
}
