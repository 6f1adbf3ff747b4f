#!/usr/bin/env bash
# Makes link.inp, link.mass.mtx, link.stiffness.mtx, link.nodes.txt and link.reference.txt, which are kept beside this script, anew.
# Needs CalculiX (Debian: calculix-ccx; 2.20 made those that are kept) and python3.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$here"/*.inp "$here"/*.py "$work"
cd "$work"
python3 make_mesh.py > /dev/null
ccx -i frequencies > /dev/null
ccx -i matrices > /dev/null
python3 to_matrix_market.py "$here"
cp link.inp "$here"
