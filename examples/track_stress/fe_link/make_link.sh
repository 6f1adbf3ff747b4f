#!/usr/bin/env bash
# Makes all files link.* of this folder again: mesh, matrices and frequencies like examples/link_from_fe, then the stress at
# named nodes, which is checked against a load case of CalculiX. Prints the results of the checks.
# Needs CalculiX (Debian: calculix-ccx; 2.20 made the stored files) and python3.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
shared=$here/../../link_from_fe
"$shared"/make_matrices.sh "$here"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$shared"/hexahedra.py "$here"/{stress_operator.py,link.inp} "$work"
cd "$work"
python3 stress_operator.py load
ccx -i load > /dev/null
python3 stress_operator.py write "$here"
