# Sourced by the other scripts: the repository's root and one set of cargo flags, so that no step
# rebuilds what another has built.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
PATH=$PATH:${CARGO_HOME:-$HOME/.cargo}/bin

# After the subcommand: clippy and nextest are programs of their own, and would not see an argument before their name.
linking=(--config tools/shaderc.toml) # how shaderc links on Debian
# The doors of other languages and the window are half of all crates, and Rhino's decoder takes a sixth of the time of
# the others: tools/test_doors has them.
flags=("${linking[@]}" --workspace --exclude selvedge-viewer --exclude selvedge-python --exclude selvedge-capi)
flags+=(--no-default-features --features selvedge/compile-shaders,selvedge-io/scene)
doors=("${linking[@]}" -p selvedge-viewer -p selvedge-python -p selvedge-capi -p selvedge-cli -p selvedge-io)

# say TEXT: a heading between the outputs of the steps.
say() { printf '\n== %s\n' "$*" >&2; }
