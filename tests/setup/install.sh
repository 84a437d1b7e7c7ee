# shellcheck shell=sh disable=SC2154 # read by run.sh, which sets what it uses
# install.sh on machines with a stand-in for apt: which suite it takes, what it leaves alone, how it fails.
#
# The stand-in reads its world from files: `release` and `backports` hold the version of the driver there, `installed` the
# one on the machine, `offline` makes mirrors fail; `log` gets each update and install.

codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")

# apt_machine NAME INSTALLED RELEASE BACKPORTS
apt_machine() {
    world=$tmp/apt-machines/$1
    bin=$world/bin
    mkdir -p "$bin" "$world/sources.list.d"
    echo "$2" >"$world/installed"
    echo "$3" >"$world/release"
    if [ -n "$4" ]; then echo "$4" >"$world/backports"; fi
    echo "deb http://mirror.example.org/debian $codename main" >"$world/sources.list"
    : >"$world/log"
    stub "$bin/id" <<END
echo \${FAKE_UID:-0}
END
    stub "$bin/apt-config" <<END
echo "machine_main='$world/sources.list'"
echo "machine_parts='$world/sources.list.d'"
END
    stub "$bin/apt-get" <<END
world=$world
$apt_arguments
case \$action in
    update)
        echo "update\${added:+ with backports}" >>\$world/log
        if [ -f \$world/offline ] || { [ -n "\$added" ] && ! [ -f \$world/backports ]; }; then exit 100; fi
        ;;
    install)
        echo "install\${suite:+ from \$suite}:\$packages" >>\$world/log
        if [ -n "\$suite" ]; then cat \$world/backports; else cat \$world/release; fi >\$world/installed
        ;;
esac
END
    stub "$bin/apt-cache" <<END
world=$world
$apt_arguments
if [ -n "\$suite" ] && [ -z "\$added" ]; then exit 100; fi
echo 'mesa-vulkan-drivers:'
echo "  Installed: \$(cat \$world/installed)"
if [ -n "\$suite" ]; then from=backports; else from=release; fi
echo "  Candidate: \$(cat \$world/\$from)"
END
}

# For the stand-ins: reads the arguments of apt into suite, action, packages, and added: the source that was added.
# shellcheck disable=SC2016 # the stand-ins expand it
apt_arguments='
suite= action= packages= added=
while [ $# -gt 0 ]; do
    case $1 in
        Dir::Etc::SourceParts=*) added=$(find "${1#*=}" -name "added-backports.*") ;;
        APT::Default-Release=*) suite=${1#*=} ;;
        -t) suite=$2; shift ;;
        update | install | policy) action=$1 ;;
        -* | *::*) ;;
        *) packages="$packages $1" ;;
    esac
    shift
done'

# installing NAME CODE LOG [PACKAGE...]: what was asked of apt, and that the machine's own sources are as they were.
installing() {
    name=$1 expected_code=$2 expected_log=$3
    shift 3
    before=$(cat "$world/sources.list" && find "$world/sources.list.d")
    code=0
    PATH=$bin:$tmp/tools sh "$scripts/install.sh" "$@" >"$world/output" 2>&1 || code=$?
    check "install: $name, exit code" "$expected_code" "$code"
    check "install: $name, apt" "$expected_log" "$(cat "$world/log")"
    check "install: $name, sources" "$before" "$(cat "$world/sources.list" && find "$world/sources.list.d")"
}

apt_machine new-release '(none)' 25.2.8-0ubuntu0.24.04.1 ''
installing 'a release that is new enough' 0 'update
install: libvulkan1 mesa-vulkan-drivers' libvulkan1 mesa-vulkan-drivers

apt_machine old-release 22.3.6-1+deb12u2 22.3.6-1+deb12u2 25.0.7-2~bpo12+1
installing 'an old release with backports' 0 "update
update with backports
install from $codename-backports: libvulkan1 mesa-vulkan-drivers" libvulkan1 mesa-vulkan-drivers

apt_machine epoch '(none)' 1:9.0.1 1:25.0.1
installing 'versions with an epoch' 0 "update
update with backports
install from $codename-backports: mesa-vulkan-drivers" mesa-vulkan-drivers

apt_machine no-backports '(none)' 23.2.1 ''
installing 'an old release without backports' 0 'update
update with backports
install: mesa-vulkan-drivers' mesa-vulkan-drivers

apt_machine nothing-newer 23.2.1 23.2.1 ''
installing 'nothing newer' 3 'update
update with backports' mesa-vulkan-drivers

apt_machine old-backports 20.3.5 20.3.5 21.2.1
installing 'backports that are too old' 3 'update
update with backports' mesa-vulkan-drivers

apt_machine other '(none)' 22.3.6 25.0.7
installing 'something other than the driver' 0 'update
install: gcc libc6-dev' gcc libc6-dev

apt_machine offline '(none)' 25.0.7 ''
: >"$world/offline"
installing 'no network' 1 'update' mesa-vulkan-drivers

apt_machine user '(none)' 25.0.7 ''
export FAKE_UID=1000
installing 'neither root nor sudo' 4 '' mesa-vulkan-drivers
stub "$bin/sudo" <<'END'
echo 'sudo: a password is required' >&2
exit 1
END
installing 'sudo that asks for a password' 4 '' mesa-vulkan-drivers
stub "$bin/sudo" <<'END'
shift
FAKE_UID=0
export FAKE_UID
"$@"
END
installing 'sudo' 0 'update
install: mesa-vulkan-drivers' mesa-vulkan-drivers
unset FAKE_UID

apt_machine no-apt '(none)' 25.0.7 ''
rm "$bin/apt-get"
installing 'another system' 4 '' mesa-vulkan-drivers
