#!/usr/bin/env bash
# Makes link.inp, link.mass.mtx, link.stiffness.mtx, link.nodes.txt and link.reference.txt again, which are stored in this folder.
#   make_matrices.sh [FOLDER]   the files for the mesh of FOLDER/make_mesh.py, stored in FOLDER
# Needs CalculiX (Debian: calculix-ccx; 2.20 made the stored files) and python3.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=$(cd "${1:-$here}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$here"/{hexahedra,to_matrix_market}.py "$here"/frequencies.inp "$here"/matrices.inp "$work"
cp "$folder"/make_mesh.py "$work"
cd "$work"
python3 make_mesh.py
ccx -i frequencies > /dev/null
ccx -i matrices > /dev/null
python3 to_matrix_market.py "$folder"
cp link.inp "$folder"
