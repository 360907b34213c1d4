# What app/run and tests/run share: installing the packages of app/packages.txt and building a
# preset. To be sourced by bash; every failure prints one line and returns non-zero.
# MIDWAY_NO_INSTALL=1 leaves installing to the user (other distributions, own builds).

midway_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say_error() { printf 'midway: error: %s\n' "$*" >&2; }

# packages_of SECTION...: the package names of these sections, one a line.
packages_of() {
    local section
    for section in "$@"; do
        sed -n "/^\[$section\]/,/^\[/ { /^\[/d; s/#.*//; s/[[:space:]]//g; /^$/d; p }" \
            "$midway_root/app/packages.txt"
    done
}

is_installed() {
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# install_packages SECTION...: installs what is missing; silent and quick where nothing is.
install_packages() {
    [ "${MIDWAY_NO_INSTALL:-}" = 1 ] && return 0
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        say_error "this system has no apt-get (app/packages.txt lists Debian 12 packages);" \
            "install their equivalents and set MIDWAY_NO_INSTALL=1"
        return 1
    fi
    local package missing=()
    for package in $(packages_of "$@"); do
        is_installed "$package" || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return 0

    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            say_error "packages are missing and neither root nor sudo is at hand (${missing[*]});" \
                "install them as root"
            return 1
        fi
        as_root=(sudo)
    fi
    printf 'Installing %s\n' "${missing[*]}" >&2
    mkdir -p "$midway_root/build" || return 1
    local log="$midway_root/build/install.log"
    if ! { "${as_root[@]}" apt-get update &&
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        say_error "packages could not be installed ($log); mend apt-get or install them by hand"
        return 1
    fi
}

# build_preset PRESET TARGET...: configures and builds; speaks only where it fails.
build_preset() {
    local preset=$1 directory="$midway_root/build/$1"
    shift
    mkdir -p "$directory" || return 1
    local log="$directory/build.log" generator=() targets=()
    # A configured directory keeps its generator; a new one takes Ninja where it exists.
    if [ ! -f "$directory/CMakeCache.txt" ] && command -v ninja >/dev/null; then
        generator=(-G Ninja)
    fi
    [ $# -gt 0 ] && targets=(--target "$@")
    if ! (cd "$midway_root" && cmake --preset "$preset" "${generator[@]}" &&
        cmake --build "$directory" --parallel "${MIDWAY_JOBS:-$(nproc)}" "${targets[@]}") \
        >"$log" 2>&1; then
        # The compiler's first messages, or else what was said last.
        { grep -E -A6 'error:|CMake Error|undefined reference' "$log" || tail -n 20 "$log"; } |
            head -n 60 >&2
        say_error "the $preset build failed ($log); the first error stands above"
        return 1
    fi
}
