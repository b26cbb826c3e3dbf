//! The utilities that laws may call, against values by hand.

use umat::provide;

unsafe extern "C" {
    fn rotsig_(
        s: *const f64,
        r: *const f64,
        turned: *mut f64,
        kind: *const i32,
        direct: *const i32,
        shears: *const i32,
    );
    fn sinv_(s: *const f64, mean: *mut f64, mises: *mut f64, direct: *const i32, shears: *const i32);
    fn sprinc_(s: *const f64, values: *mut f64, kind: *const i32, direct: *const i32, shears: *const i32);
    fn sprind_(
        s: *const f64,
        values: *mut f64,
        axes: *mut f64,
        kind: *const i32,
        direct: *const i32,
        shears: *const i32,
    );
    fn getoutdir_(text: *mut u8, length: *mut i32, room: usize);
}

/// A quarter turn about z, column by column: x goes to y.
const QUARTER: [f64; 9] = [0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn a_tensor_is_turned() {
    provide();
    let (stress, mut turned) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0.0; 6]);
    // SAFETY: every address is that of as many values as the utility reads or writes.
    unsafe { rotsig_(stress.as_ptr(), QUARTER.as_ptr(), turned.as_mut_ptr(), &1, &3, &3) };
    assert_eq!(turned, [2.0, 1.0, 3.0, -4.0, -6.0, 5.0]);
    // Half of a right angle turns a shear into stretches: as a strain of engineers it is worth half.
    let h = 0.5_f64.sqrt();
    let eighth = [h, h, 0.0, -h, h, 0.0, 0.0, 0.0, 1.0];
    for (kind, worth) in [(1, 2.0), (2, 1.0)] {
        let (shear, mut turned) = ([0.0, 0.0, 0.0, 2.0], [0.0; 4]);
        // SAFETY: as above.
        unsafe { rotsig_(shear.as_ptr(), eighth.as_ptr(), turned.as_mut_ptr(), &kind, &3, &1) };
        let expected = [-worth, worth, 0.0, 0.0];
        turned.iter().zip(expected).for_each(|(a, b)| assert!((a - b).abs() < 1e-15, "{turned:?}"));
    }
}

#[test]
fn invariants_and_principal_values_are_those_of_shear() {
    let (shear, mut mean, mut mises) = ([5.0, 5.0, 5.0, 3.0], 0.0, 0.0);
    // SAFETY: every address is that of as many values as the utility reads or writes.
    unsafe { sinv_(shear.as_ptr(), &raw mut mean, &raw mut mises, &3, &1) };
    assert!((mean - 5.0).abs() < 1e-15 && (mises - 3.0 * 3.0_f64.sqrt()).abs() < 1e-14);
    for (kind, worth) in [(1, 3.0), (2, 1.5)] {
        let (mut only, mut values, mut axes) = ([0.0; 3], [0.0; 3], [0.0; 9]);
        // SAFETY: as above.
        unsafe {
            sprinc_(shear.as_ptr(), only.as_mut_ptr(), &kind, &3, &1);
            sprind_(shear.as_ptr(), values.as_mut_ptr(), axes.as_mut_ptr(), &kind, &3, &1);
        }
        assert_eq!(only, values);
        // Row by row an axis, which shear turns into itself but for its value.
        for (i, value) in values.iter().enumerate() {
            let n = [axes[i], axes[i + 3], axes[i + 6]];
            let image = [5.0 * n[0] + worth * n[1], worth * n[0] + 5.0 * n[1], 5.0 * n[2]];
            (0..3).for_each(|j| assert!((image[j] - value * n[j]).abs() < 1e-14, "{values:?} {axes:?}"));
            assert!((n.iter().map(|n| n * n).sum::<f64>() - 1.0).abs() < 1e-14);
        }
        let mut sorted = values;
        sorted.sort_by(f64::total_cmp);
        assert!((sorted[0] - 5.0 + worth).abs() < 1e-14 && (sorted[2] - 5.0 - worth).abs() < 1e-14, "{sorted:?}");
    }
}

#[test]
fn the_folder_is_that_of_the_program() {
    let (mut text, mut length) = ([0_u8; 256], 0_i32);
    // SAFETY: the text has the room that is said.
    unsafe { getoutdir_(text.as_mut_ptr(), &raw mut length, text.len()) };
    let folder = std::env::current_dir().unwrap().display().to_string();
    assert_eq!(&text[..length as usize], folder.as_bytes());
    assert!(text[length as usize..].iter().all(|letter| *letter == b' '));
}
