#!/bin/sh
# Renders each built-in scene by each shipped pipeline: scripts/demo.sh VOXGI [OUT]
#
# VOXGI is the release binary; the pictures go to OUT/SCENE/PIPELINE/ (OUT: out/demo). Shows each pair as it goes. Any
# failure fails the demo, after the other pairs have had their turn, so that one run shows all that is wrong.
#
# Exit codes: 0 all rendered, 1 some failed or there was nothing to render.
set -eu
cd "$(dirname "$0")/.."
voxgi=$1
out=${2:-out/demo}

pairs=0
failed=
for scene in scenes/*.glb; do
    for pipeline in pipelines/*.ron; do
        if ! [ -f "$scene" ] || ! [ -f "$pipeline" ]; then continue; fi
        pairs=$((pairs + 1))
        scene_name=$(basename "$scene" .glb)
        pipeline_name=$(basename "$pipeline" .ron)
        folder=$out/$scene_name/$pipeline_name
        echo "demo: $scene_name by $pipeline_name -> $folder"
        rm -rf "$folder" # no picture of an earlier run passes for one of this
        mkdir -p "$folder"
        "$voxgi" render "$scene" -p "$pipeline_name" --out "$folder" </dev/null ||
            failed="$failed
demo:   $scene_name by $pipeline_name"
    done
done

if [ $pairs = 0 ]; then
    echo "demo: there is nothing to render: scenes/*.glb by pipelines/*.ron" >&2
    exit 1
fi
if [ -n "$failed" ]; then
    echo "demo: of $pairs pairs, these failed:$failed" >&2
    exit 1
fi
echo "demo: all $pairs pairs rendered; the pictures are in $out/SCENE/PIPELINE/"
