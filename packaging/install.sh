#!/bin/sh
# Installs dem-pack and dem-run into ~/.local/bin, or into the folder that CRUMBLE_BIN names. Nothing else is changed.
# At a release, the address of its files and its version take the places between @.
set -eu

address=${CRUMBLE_ADDRESS:-@ADDRESS@}
version=@VERSION@
bin=${CRUMBLE_BIN:-$HOME/.local/bin}

fail() {
    printf 'install.sh: %s\n' "$1" >&2
    exit 1
}

fetch() {
    if command -v curl > /dev/null; then
        curl -fsSL "$address/$1" -o "$folder/$1" || fail "cannot fetch $address/$1"
    else
        wget -q "$address/$1" -O "$folder/$1" || fail "cannot fetch $address/$1 (by wget; there is no curl)"
    fi
}

main() {
    case "$(uname -s)-$(uname -m)" in
        Linux-x86_64) platform=linux-x86_64 ;;
        Linux-aarch64 | Linux-arm64) platform=linux-aarch64 ;;
        Darwin-x86_64) platform=macos-x86_64 ;;
        Darwin-arm64) platform=macos-aarch64 ;;
        *) fail "there are no programs for $(uname -s) $(uname -m); with Rust: cargo install --locked dem-pack dem-run" ;;
    esac
    name=crumble-dem-$version-$platform
    folder=$(mktemp -d)
    trap 'rm -rf "$folder"' EXIT

    fetch "$name.tar.gz"
    fetch SHA256SUMS
    cd "$folder"
    grep " $name.tar.gz\$" SHA256SUMS > wanted || fail "SHA256SUMS has no line for $name.tar.gz"
    if command -v sha256sum > /dev/null; then
        sha256sum -c wanted > /dev/null
    else
        shasum -a 256 -c wanted > /dev/null
    fi || fail "$name.tar.gz is damaged: its SHA-256 is another one; try again"

    tar -xzf "$name.tar.gz" "$name/dem-pack" "$name/dem-run"
    "$name/dem-run" --version > /dev/null || fail "the programs do not run here; they need glibc 2.28 or later, or macOS 11 or later"
    mkdir -p "$bin"
    mv -f "$name/dem-pack" "$name/dem-run" "$bin"
    printf 'dem-pack and dem-run %s are in %s.\n' "$version" "$bin"
    case ":$PATH:" in
        *":$bin:"*) ;;
        *) printf 'It is not on your PATH yet:  export PATH="%s:$PATH"\n' "$bin" ;;
    esac
}

# The last line: a script that arrived in part does nothing.
main
