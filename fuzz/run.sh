#!/bin/sh
# Fuzzes one target for some seconds: sh fuzz/run.sh pattern 60. Needs `cargo install cargo-fuzz`; the switch lets the
# stable compiler build with the sanitizer, here and nowhere else.
set -eu
cd "$(dirname "$0")/.."
RUSTC_BOOTSTRAP=1 cargo fuzz run --fuzz-dir fuzz "$1" -- -max_total_time="${2:-60}" -max_len=4000
