#!/bin/sh
# Says what Vulkan device this machine has, without root, network, compiler or GPU work, as one line:
#
#   gpu NAME          hardware
#   software VERSION  only Mesa's software driver (lavapipe), of this version
#   none REASON       nothing that a program could use
#
# vulkaninfo is asked where it is installed, since that asks the drivers. Otherwise the files decide: the Vulkan loader,
# the drivers' manifests, and for hardware a device node that the user may open, whose kernel driver is the one that a
# manifest's driver is for. (Mesa's packages bring the drivers of all vendors, and a node may belong to a display
# without a GPU, so neither tells anything alone.) A driver that the files promise may still fail: then installing
# vulkan-tools, which has vulkaninfo, makes the next set-up see it.
#
# --root DIR looks at the files under DIR in place of /, and never runs vulkaninfo; the tests use it.
set -eu

root=
if [ "${1:-}" = --root ]; then root=$2; fi

# Reads `vulkaninfo --summary`. Drivers that conform to nothing are left out, as wgpu leaves them out.
judge_summary() {
    awk -F ' *= *' '
        function judge() {
            if (type != "" && conformance !~ /^0\./) {
                if (type ~ /_(INTEGRATED|DISCRETE|VIRTUAL)_GPU$/ && gpu == "") gpu = name
                if (driver == "DRIVER_ID_MESA_LLVMPIPE" && match(info, /[0-9]+\.[0-9.]+/))
                    software = substr(info, RSTART, RLENGTH)
                else other = name
            }
            type = name = driver = info = conformance = ""
        }
        /^GPU[0-9]+:/ { judge() }
        $1 ~ /deviceType$/ { type = $2 }
        $1 ~ /deviceName$/ { name = $2 }
        $1 ~ /driverID$/ { driver = $2 }
        $1 ~ /driverInfo$/ { info = $2 }
        $1 ~ /conformanceVersion$/ { conformance = $2 }
        END {
            judge()
            if (gpu != "") print "gpu " gpu
            else if (software != "") print "software " software
            else if (other != "") print "none (" other " is not a device to measure on)"
            else print "none (vulkaninfo lists no device)"
        }'
}

if [ -z "$root" ] && command -v vulkaninfo >/dev/null 2>&1; then
    timeout 10 vulkaninfo --summary 2>/dev/null | judge_summary
    exit
fi

# first_file NAME: the path of a shared library, where one is installed.
first_file() {
    for candidate in "$root"/usr/lib/*-linux-*/"$1" "$root/usr/lib64/$1" "$root/usr/lib/$1" \
        "$root"/usr/local/lib/*-linux-*/"$1" "$root/usr/local/lib/$1"; do
        if [ -e "$candidate" ]; then
            echo "$candidate"
            return
        fi
    done
}

# The manifests that the loader would read, one a line, without those for another processor.
manifests() {
    listed=${VK_DRIVER_FILES:-${VK_ICD_FILENAMES:-}}
    if [ -z "$root" ] && [ -n "$listed" ]; then
        echo "$listed" | tr : '\n'
        return
    fi
    for folder in etc usr/local/etc usr/local/share usr/share; do
        for manifest in "$root/$folder"/vulkan/icd.d/*.json; do
            case $manifest in
                *.i[3-6]86.json) case $(uname -m) in i?86) ;; *) continue ;; esac ;;
            esac
            echo "$manifest"
        done
    done
}

# The library that a manifest names: a path, a path from the manifest's folder, or a name that the linker finds.
library_of() {
    path=$(sed -n 's/.*"library_path"[ \t]*:[ \t]*"\([^"]*\)".*/\1/p' "$1")
    case $path in
        /*) echo "$root$path" ;;
        */*) echo "$(dirname "$1")/$path" ;;
        *) first_file "$path" ;;
    esac
}

# The kernel drivers of the device nodes that the user may open, one a line.
kernel_drivers() {
    for node in "$root"/dev/dri/renderD*; do
        if [ -r "$node" ] && [ -w "$node" ]; then
            link=$(readlink "$root/sys/class/drm/${node##*/}/device/driver" || true)
            echo "${link##*/}"
        fi
    done
    if [ -r "$root/dev/nvidiactl" ] && [ -w "$root/dev/nvidiactl" ]; then echo nvidia; fi
}

# drives KERNEL_DRIVER LIBRARY: whether the Vulkan driver is for the devices of that kernel driver.
drives() {
    case $1:${2##*/} in
        i915:*intel* | xe:*intel* | amdgpu:*radeon* | amdgpu:*amdvlk* | nvidia*:*nvidia* | nouveau:*nouveau*) ;;
        msm*:*freedreno* | v3d:*broadcom* | panfrost:*panfrost* | panthor:*panfrost* | asahi:*asahi*) ;;
        virtio*:*virtio* | virtio*:*gfxstream* | powervr:*powervr*) ;;
        *) return 1 ;;
    esac
}

if [ -z "$(first_file libvulkan.so.1)" ]; then
    echo "none (there is no Vulkan loader, libvulkan.so.1)"
    exit
fi
drivers=$(kernel_drivers)
software=
while read -r manifest; do
    [ -f "$manifest" ] || continue
    library=$(library_of "$manifest")
    [ -e "$library" ] || continue
    for kernel_driver in $drivers; do
        if drives "$kernel_driver" "$library"; then
            echo "gpu ${library##*/} on $kernel_driver"
            exit
        fi
    done
    case $library in
        *libvulkan_lvp*) software=$(LC_ALL=C grep -ao 'Mesa [0-9][0-9]*\.[0-9.]*' "$library" | sed 's/^Mesa //;q') ;;
    esac
done <<END
$(manifests)
END

if [ -n "$software" ]; then
    echo "software $software"
else
    echo "none (no driver is installed for a device that this user may open)"
fi
