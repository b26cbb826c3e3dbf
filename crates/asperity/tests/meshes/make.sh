#!/usr/bin/env bash
# Writes the sample meshes with Gmsh 4 (pip install gmsh). They are committed; the tests read them as they are.
set -euo pipefail
cd "$(dirname "$0")"
make_mesh() { # name, geometry, dimension, order, incomplete
    for format in msh22 msh41; do
        for bin in 0 1; do
            out=$1-${format#msh}$([ $bin = 1 ] && echo b || echo a).msh
            gmsh "$2.geo" "-$3" -v 2 -format $format -setnumber Mesh.Binary $bin -setnumber Mesh.ElementOrder "$4" \
                -setnumber Mesh.SecondOrderIncomplete "$5" -o "$out"
        done
    done
}
make_inp() { # name, geometry, dimension, order
    gmsh "$2.geo" "-$3" -v 2 -format inp -setnumber Mesh.ElementOrder "$4" -setnumber Mesh.SecondOrderIncomplete 1 \
        -setnumber Mesh.SaveGroupsOfNodes 1 -o "$1.inp"
}
make_mesh plane1 plane 2 1 0
make_mesh plane2 plane 2 2 1
make_mesh plane2full plane 2 2 0
make_mesh solid1 solid 3 1 0
make_mesh solid2 solid 3 2 1
make_mesh brick27 brick27 3 2 0
make_inp plane1 plane 2 1
make_inp plane2 plane 2 2
make_inp solid1 solid 3 1
make_inp solid2 solid 3 2
