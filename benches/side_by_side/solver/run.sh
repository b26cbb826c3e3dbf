#!/bin/sh
# Runs frontal, MUMPS and (with FAER=1) faer's sparse LU on the same matrix files, one thread each, in turn, and prints
# the medians of three runs and their ratios. See README.md for what must be installed.
set -eu
cd "$(dirname "$0")/../../.."
work=${WORK:-/tmp/frontal_side_by_side}
models=${MODELS:-"quad8:90:2 hex8:24:3 hex8:32:3"}
rounds=${ROUNDS:-3}
export OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 RAYON_NUM_THREADS=1

mkdir -p "$work"
cargo build --release --quiet -p frontal --example market
[ "${FAER:-0}" = 0 ] || cargo build --release --quiet -p oracles
cc -O2 -I/usr/include/mumps_seq benches/side_by_side/solver/mumps.c -o "$work/mumps" -ldmumps_seq -lm

for model in $models; do
    kind=${model%%:*} rest=${model#*:}
    size=${rest%%:*} block=${rest#*:} symmetric=
    case $block in *:symmetric) block=${block%:symmetric} symmetric=symmetric ;; esac
    matrix=$work/$kind$size$symmetric.mtx
    # Whole or not at all, if the run is stopped.
    [ -f "$matrix" ] || { target/release/examples/market write "$kind" "$size" "$matrix.part" $symmetric && mv "$matrix.part" "$matrix"; }
    : > "$work/lines"
    round=0
    while [ $round -lt "$rounds" ]; do
        target/release/examples/market solve "$matrix" "$block" >> "$work/lines"
        "$work/mumps" "$matrix" >> "$work/lines"
        if [ "$symmetric" ]; then
            target/release/examples/market solve "$matrix" "$block" symmetric >> "$work/lines"
            "$work/mumps" "$matrix" symmetric >> "$work/lines"
        fi
        [ "${FAER:-0}" = 0 ] || target/release/faer_lu "$matrix" >> "$work/lines"
        round=$((round + 1))
    done
    echo "== $kind $size"
    awk -f benches/side_by_side/solver/medians.awk "$work/lines"
done
