"""Measures glTF scenes by trimesh, a loader that shares no code with voxgi: python measure.py FOLDER > truth.tsv

Needs trimesh (measured with 5.2.0) and numpy from PyPI. For each .glb and .gltf in FOLDER and FOLDER/khronos: triangles, triangles without area,
the sum of all areas in m2, and the box around all triangles, all after node transforms, in 64-bit floats.
"""
import pathlib, sys
import numpy, trimesh

print("file\ttriangles\tdegenerate\tarea\tmin_x\tmin_y\tmin_z\tmax_x\tmax_y\tmax_z")
root = pathlib.Path(sys.argv[1])
for path in sorted(p for folder in (root, root / "khronos") for p in folder.glob("*.gl*")):
    scene = trimesh.load_scene(path, process=False, skip_materials=True)
    corners = []
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        mesh = scene.geometry[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            world = trimesh.transform_points(mesh.vertices.astype(numpy.float64), transform)
            corners.append(world[mesh.faces])
    if not corners:
        print(path.relative_to(root), 0, 0, 0.0, *[0.0] * 6, sep="\t")
        continue
    corners = numpy.concatenate(corners)
    areas = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    box = [*corners.reshape(-1, 3).min(axis=0), *corners.reshape(-1, 3).max(axis=0)]
    print(path.relative_to(root), len(corners), int((areas == 0).sum()), *(f"{x:.9g}" for x in [areas.sum(), *box]), sep="\t")
