# shellcheck shell=sh disable=SC2154 # read by run.sh, which sets what it uses
# setup.sh as a whole, in a copy of the repository, on the machines that install.sh's tests make.

# rust_machine NAME INSTALLED RELEASE BACKPORTS: with Rust, compilers, and a vulkaninfo that shows what apt installed.
rust_machine() {
    apt_machine "$@"
    repository=$world/repository
    mkdir -p "$repository"
    cp -R "$scripts" "$here/../../Cargo.toml" "$repository"
    stub "$bin/vulkaninfo" <<END
if ! grep -q none $world/installed; then
    sed "s/Mesa 22.3.6/Mesa \$(cat $world/installed)/" "$here/vulkaninfo/software-old.txt"
fi
END
    echo "echo 'rustc 1.999.0 (abcdef012 2030-01-01)'" | stub "$bin/rustc"
    stub "$bin/cargo" </dev/null
    stub "$bin/cc" </dev/null
    stub "$bin/c++" </dev/null
}

# setting_up NAME CODE LOG SAID: SAID is in the last line of its messages.
setting_up() {
    code=0
    : >"$world/log"
    PATH=$bin:$tmp/tools sh "$repository/scripts/setup.sh" --lints >"$world/output" 2>&1 || code=$?
    check "setup: $1, exit code" "$2" "$code"
    check "setup: $1, apt" "$3" "$(cat "$world/log")"
    last=$(tail -n 1 "$world/output")
    case $last in
        *"$4"*) last=$4 ;;
    esac
    check "setup: $1, message" "$4" "$last"
}

rust_machine good 25.0.7 22.3.6 25.0.7
setting_up 'a good device' 0 '' 'Vulkan device: software 25.0.7'

rust_machine bare '(none)' 22.3.6 25.0.7
setting_up 'a bare machine' 0 "update
update with backports
install from $codename-backports: libvulkan1 mesa-vulkan-drivers" 'Vulkan device: software 25.0.7'
setting_up 'a bare machine again' 0 '' 'Vulkan device: software 25.0.7'

rust_machine old 23.2.1 23.2.1 ''
setting_up 'an old device and nothing newer' 0 'update
update with backports' 'on the wall clock'
setting_up 'an old device and nothing newer, again' 0 '' 'on the wall clock'
echo '(none)' >"$world/installed"
setting_up 'the old device gone' 0 'update
update with backports
install: libvulkan1 mesa-vulkan-drivers' 'on the wall clock'

rust_machine offline-setup '(none)' 25.0.7 ''
: >"$world/offline"
setting_up 'no network' 0 'update' 'tests that render fail'
rm "$world/offline"
setting_up 'network again' 0 'update
install: libvulkan1 mesa-vulkan-drivers' 'Vulkan device: software 25.0.7'

rust_machine in-vain '(none)' 25.0.7 ''
echo 'exit 1' | stub "$bin/vulkaninfo"
setting_up 'a driver that does not help' 0 'update
install: libvulkan1 mesa-vulkan-drivers' 'tests that render fail'
setting_up 'a driver that does not help, again' 0 '' 'tests that render fail'

rust_machine user-setup 22.3.6 22.3.6 25.0.7
export FAKE_UID=1000
setting_up 'an old device without root' 0 '' 'on the wall clock'
unset FAKE_UID

rust_machine no-cargo 25.0.7 25.0.7 ''
rm "$bin/cargo"
setting_up 'no cargo' 1 '' 'there is no cargo: install Rust'

rust_machine old-rust 25.0.7 25.0.7 ''
echo "echo 'rustc 1.63.0'" | stub "$bin/rustc"
setting_up 'an old Rust' 1 '' 'and this is 1.63.0'

rust_machine no-toolchain 25.0.7 25.0.7 ''
echo 'echo "no default toolchain is configured" >&2; exit 1' | stub "$bin/rustc"
setting_up 'rustup without a toolchain' 1 '' 'rustc does not run (no default toolchain is configured)'

rust_machine no-lints 25.0.7 25.0.7 ''
echo 'exit 1' | stub "$bin/cargo"
setting_up 'no rustfmt, and no rustup' 1 '' 'rustfmt or clippy is missing'
echo "echo \"rustup \$*\" >>$world/log" | stub "$bin/rustup"
setting_up 'no rustfmt' 0 'rustup component add rustfmt clippy' 'Vulkan device: software 25.0.7'

for compiler in cc c++; do
    rust_machine "no-$compiler" 25.0.7 25.0.7 ''
    rm "$bin/$compiler"
    setting_up "no $compiler" 0 'update
install: g++ libc6-dev' 'Vulkan device: software 25.0.7'
    : >"$world/offline"
    setting_up "no $compiler and no network" 1 'update' 'there is no C or no C++ compiler'
done
