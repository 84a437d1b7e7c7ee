# shellcheck shell=sh disable=SC2154 # read by run.sh, which sets what it uses
# What device.sh says of machines made of files, and of what vulkaninfo prints.

library_folder=usr/lib/x86_64-linux-gnu

# machine NAME: an empty one, with the Vulkan loader.
machine() {
    root=$tmp/machines/$1
    mkdir -p "$root/$library_folder" "$root/usr/share/vulkan/icd.d" "$root/dev/dri" "$root/sys/class/drm"
    : >"$root/$library_folder/libvulkan.so.1"
}

# driver MANIFEST LIBRARY_PATH [CONTENT]: a Vulkan driver in the machine.
driver() {
    printf '{\n  "ICD": { "api_version": "1.4.305",\n    "library_path": "%s" }\n}\n' "$2" \
        >"$root/usr/share/vulkan/icd.d/$1"
    printf 'ELF\000%s\000\n' "${3:-}" >"$root/$library_folder/${2##*/}"
}

# node NAME KERNEL_DRIVER: a render node that anyone may open.
node() {
    : >"$root/dev/dri/$1"
    mkdir -p "$root/sys/class/drm/$1/device"
    ln -s "../../../../bus/pci/drivers/$2" "$root/sys/class/drm/$1/device/driver"
}

mesa_for_all() {
    driver lvp_icd.json libvulkan_lvp.so "Mesa $1 (LLVM 19.1.7)"
    driver intel_icd.json libvulkan_intel.so
    driver radeon_icd.x86_64.json /$library_folder/libvulkan_radeon.so
}

says() { check "device: $1" "$2" "$(PATH=$tmp/tools sh "$scripts/device.sh" --root "$root")"; }

machine bare
rm "$root/$library_folder/libvulkan.so.1"
mesa_for_all 25.0.7
says 'no loader' 'none (there is no Vulkan loader, libvulkan.so.1)'

machine loader
says 'a loader and no driver' 'none (no driver is installed for a device that this user may open)'

machine software
mesa_for_all 25.0.7-2
says 'drivers of all vendors without hardware' 'software 25.0.7'

machine path
driver lvp_icd.x86_64.json "/$library_folder/libvulkan_lvp.so" 'Mesa 22.3.6 (LLVM 15.0.6)'
says 'a manifest with a path' 'software 22.3.6'

machine other-processor
driver lvp_icd.i686.json libvulkan_lvp.so 'Mesa 25.0.7'
says 'a driver for another processor' 'none (no driver is installed for a device that this user may open)'

machine removed
driver lvp_icd.json libvulkan_lvp.so 'Mesa 25.0.7'
rm "$root/$library_folder/libvulkan_lvp.so"
says 'a manifest without its library' 'none (no driver is installed for a device that this user may open)'

machine radeon
mesa_for_all 22.3.6
node renderD128 amdgpu
says 'hardware beside old software' 'gpu libvulkan_radeon.so on amdgpu'

machine second
mesa_for_all 25.0.7
node renderD128 vgem
node renderD129 i915
says 'hardware at the second node' 'gpu libvulkan_intel.so on i915'

machine virtual
mesa_for_all 25.0.7
node renderD128 vgem
says 'a node without a GPU' 'software 25.0.7'

machine mismatch
driver intel_icd.json libvulkan_intel.so
node renderD128 amdgpu
says 'hardware with the driver of another vendor' 'none (no driver is installed for a device that this user may open)'

machine mismatch-again
driver radeon_icd.json libvulkan_radeon.so
node renderD128 i915
says 'hardware with the driver of yet another' 'none (no driver is installed for a device that this user may open)'

machine nvidia
driver nvidia_icd.json libGLX_nvidia.so.0
: >"$root/dev/nvidiactl"
says 'NVIDIA in a container' 'gpu libGLX_nvidia.so.0 on nvidia'

machine locked
mesa_for_all 25.0.7
node renderD128 i915
chmod 000 "$root/dev/dri/renderD128"
[ "$(id -u)" = 0 ] || says 'a node that the user may not open' 'software 25.0.7'

# vulkaninfo NAME SAID: with a vulkaninfo that prints vulkaninfo/NAME.txt.
vulkaninfo_says() {
    mkdir -p "$tmp/vulkaninfo"
    stub "$tmp/vulkaninfo/vulkaninfo" <<END
cat "$here/vulkaninfo/$1.txt"
END
    check "device: vulkaninfo, $1" "$2" "$(PATH=$tmp/vulkaninfo:$tmp/tools sh "$scripts/device.sh")"
}

vulkaninfo_says hardware-and-software 'gpu Radeon RX 7600 (RADV NAVI33)'
vulkaninfo_says software-old 'software 22.3.6'
vulkaninfo_says nonconforming 'none (vulkaninfo lists no device)'
vulkaninfo_says other-software 'none (SwiftShader Device (LLVM 10.0.0) is not a device to measure on)'
