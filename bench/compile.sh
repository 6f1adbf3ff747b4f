#!/usr/bin/env bash
# What it costs to compile a first program with polybody, beside the budget. Reported, not asserted.
#   bench/compile.sh [FILE]    (default examples/ex01_pendulum.cpp; CXX and CXXFLAGS are honoured)
set -euo pipefail
cd "$(dirname "$0")/.."

file=${1:-examples/ex01_pendulum.cpp}
read -ra eigen <<< "$(pkg-config --cflags eigen3)"
read -ra flags <<< "${CXXFLAGS:--O2}"

python3 - "${CXX:-g++}" -std=c++20 "${flags[@]}" -Iinclude "${eigen[@]}" -c "$file" -o /dev/null << 'EOF'
import resource, subprocess, sys, time

start = time.monotonic()
subprocess.run(sys.argv[1:], check=True)
seconds = time.monotonic() - start
# The largest resident set of any process below this one (the compiler proper), in KiB.
gigabytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024**2
print(" ".join(sys.argv[1:]))
print(f"  time    {seconds:6.1f} s    budget 20 s")
print(f"  memory  {gigabytes:6.2f} GiB  budget 1 GiB")
EOF
