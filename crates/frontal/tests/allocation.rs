//! Factorising again into the same factor must not allocate.

#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{Options, Symbolic};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: hands everything to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn the_second_factorisation_allocates_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    pool.install(|| {
        for mut model in [models::quad4([8, 160]), models::hex8([10, 10, 10])] {
            for symmetric in [false, true] {
                if symmetric {
                    model.symmetrise();
                }
                let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
                let symbolic = symbolic.for_values(symmetric).expect("the same pattern");
                let mut factor = symbolic.new_factor();
                symbolic.factorise(&model.values, &mut factor).expect("a regular matrix");
                let before = ALLOCATIONS.load(Ordering::Relaxed);
                symbolic.factorise(&model.values, &mut factor).expect("a regular matrix");
                assert_eq!(ALLOCATIONS.load(Ordering::Relaxed) - before, 0, "{}", model.name);
            }
        }
    });
}
