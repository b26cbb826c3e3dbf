//! Exports the utilities that laws of shared libraries may call, `umat::SYMBOLS`, and nothing else.

const SYMBOLS: [&str; 8] =
    ["xit_", "stdb_abqerr_", "getoutdir_", "getjobname_", "rotsig_", "sinv_", "sprinc_", "sprind_"];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        for symbol in SYMBOLS {
            println!("cargo:rustc-link-arg-bins=-Wl,--export-dynamic-symbol={symbol}");
        }
    }
}
