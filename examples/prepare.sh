# For the `build` scripts of the examples, which source it in their folder: what their programs need of this repository. In a project of your
# own SCL is installed, and none of this is needed.
#
# Sets `repository`, `out` (where compiled programs go, in a folder for each example), `target` (what cargo builds into),
# `venv` and `SCL`.

repository=$(cd ../.. && pwd)
out=$repository/target/examples/${PWD##*/}
venv=$repository/target/examples/venv
# `scl run` says where it is; otherwise it is installed.
SCL=${SCL:-scl}
export SCL
# `EXAMPLES_PROFILE=release` builds with optimizations.
profile=${EXAMPLES_PROFILE:-dev}
case $profile in
dev) profile_folder=debug ;;
*) profile_folder=$profile ;;
esac

# need DEBIAN_PACKAGE COMMAND...: notes the package if the command fails. `all_there` ends with what to install.
missing=
need() {
    package=$1
    shift
    "$@" >/dev/null 2>&1 || missing="$missing $package"
}
all_there() {
    [ -z "$missing" ] || { echo "error: missing:$missing; on Debian: apt-get install$missing" >&2; exit 1; }
}

need_c() {
    need gcc command -v cc
    need make command -v make
    need pkg-config command -v pkg-config
    need protobuf-compiler command -v protoc
    need protobuf-c-compiler command -v protoc-c
    need libprotobuf-c-dev pkg-config --exists libprotobuf-c
    all_there
}
need_cpp() {
    need g++ command -v c++
    need make command -v make
    need cmake command -v cmake
    need pkg-config command -v pkg-config
    need protobuf-compiler command -v protoc
    need libprotobuf-dev pkg-config --exists protobuf
    all_there
}
need_python() {
    need python3-venv python3 -c "import ensurepip, venv"
    all_there
}

# Where cargo builds: `target`, unless it is told otherwise.
find_target() {
    target=$(cargo metadata --no-deps --format-version 1 | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')/$profile_folder
}

# As `build` in `tests/src/cargo.rs`: without what cargo tells a test about its package, and with more packages.
build_rust() {
    # shellcheck disable=SC2046
    unset $(env | sed -nE 's/^(CARGO_(PKG|MANIFEST)_[A-Z_]*)=.*/\1/p')
    # shellcheck disable=SC2086
    cargo build --locked --profile "$profile" ${SCL_TEST_PACKAGES:-} "$@"
    find_target
}

# The C library, as `cargo cinstall -p scl-c` installs it.
build_c_library() {
    build_rust -p scl-c
    SCL_CFLAGS="-I$repository/bindings/c/include"
    SCL_LIBS="-L$target -lscl -Wl,-rpath,$target"
    export SCL_CFLAGS SCL_LIBS
}

# cmake_build SOURCE BUILD [ARGUMENT...]
cmake_build() {
    source=$1
    build=$2
    shift 2
    cmake -S "$source" -B "$build" -DCMAKE_BUILD_TYPE=Release -Dscl_DIR="$repository/bindings/cpp/cmake" \
        -DSCL_LIBRARY="$target/libscl.so" -DSCL_EXECUTABLE="$(command -v "$SCL")" "$@" >/dev/null
    cmake --build "$build" --parallel
}

# A virtual environment with the package `scl`, and with the packages of a file if one is given.
build_python_package() {
    # The examples share it, and two of them may be built at the same time.
    exec 9>"$venv.lock"
    ! command -v flock >/dev/null || flock 9
    if [ ! -x "$venv/bin/maturin" ]; then
        python3 -m venv "$venv"
        "$venv/bin/pip" install --quiet --disable-pip-version-check "maturin>=1.16,<2"
    fi
    if [ -n "${1-}" ] && ! cmp -s "$1" "$out/requirements.txt"; then
        "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$1"
        cp "$1" "$out/requirements.txt"
    fi
    find_target
    installed=$venv/scl-$profile.installed
    ! python_package_is_current || return 0
    # As `pip install bindings/python` does, but faster when repeated.
    release=
    [ "$profile" = dev ] || release=--release
    rm -f "$venv"/scl-*.installed
    # With the time before the build: what changes meanwhile is built the next time.
    touch "$venv/scl.installing"
    VIRTUAL_ENV="$venv" "$venv/bin/maturin" develop $release --manifest-path "$repository/bindings/python/Cargo.toml" >/dev/null
    mv "$venv/scl.installing" "$installed"
}

# Whether nothing that the installed package is made of has changed: maturin packs and installs it each time, and where cargo was called with
# another interpreter in between, builds much of it again. Cargo lists the sources.
python_package_is_current() {
    sources=$target/libscl_native.d
    [ -f "$installed" ] && [ -f "$sources" ] || return 1
    changed=$({
        sed 's/^[^:]*: //' "$sources" | tr ' ' '\n'
        find "$repository/bindings/python/python" -name '*.py*' ! -name '*.pyc' ! -path '*/__pycache__*'
        echo "$repository/bindings/python/pyproject.toml"
        find "$repository" -maxdepth 3 -name target -prune -o \( -name Cargo.toml -o -name Cargo.lock \) -print
    } | xargs sh -c 'find "$@" -newer "$0"' "$installed" 2>/dev/null) && [ -z "$changed" ]
}

mkdir -p "$out"
