# Sourced by tests/run, examples/run and .ci/run.

# need_packages PACKAGE...
# Installs the Debian packages that are missing; on another system it says what is needed and goes on.

need_packages() {
  if ! command -v dpkg > /dev/null || ! command -v apt-get > /dev/null; then
    echo "Not a Debian system. Needed, under its own names here: $*" >&2
    return 0
  fi

  local package missing=()
  for package in "$@"; do
    dpkg -s "$package" 2> /dev/null | grep -q '^Status: .* installed$' || missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo)
    if ! command -v sudo > /dev/null; then
      echo "Please install as root: apt-get install ${missing[*]}" >&2
      return 0
    fi
  fi
  echo "Installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq < /dev/null || true
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" < /dev/null
}

# need_browser
# What plays films in the tests: npm, which brings node, and chromium. Without them these tests are skipped.
need_browser() {
  command -v npm > /dev/null || need_packages npm || true
  command -v chromium > /dev/null || need_packages chromium || true
}

# Path of any clang++ from 16 on; nothing where there is none.
find_clang() {
  local version
  for version in 16 17 18 19 20 21; do
    command -v "clang++-$version" && return 0
  done
  return 0
}
