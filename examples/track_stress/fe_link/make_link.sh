#!/usr/bin/env bash
# Makes all link.* that are kept beside this script anew: mesh, matrices and frequencies as examples/link_from_fe does, then
# the stress at named nodes, checked against a load case of CalculiX. Prints what it checks.
# Needs CalculiX (Debian: calculix-ccx; 2.20 made those that are kept) and python3.
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
