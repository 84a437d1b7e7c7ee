// The scene's triangles, in world space (metres).
//
// Cost of a corner: 1 vertex (32 B), and as much again where the scene has vertex colours or second texture
// coordinates; of a triangle's record 16 B, of its instance 128 B.

import lib/math;

struct Vertex {
    position: vec3f,
    u: f32,
    normal: vec3f,
    v: f32,
}

/// Three indices into `vertices`, and one into `instances`.
struct Triangle {
    a: u32,
    b: u32,
    c: u32,
    instance: u32,
}

struct Instance {
    to_world: mat4x3f,
    normal_to_world: mat3x3f,
    material: u32,
    /// -1 where `to_world` mirrors, so that the winding is reversed.
    flip: f32,
}

/// What only some scenes' vertices have; the same index.
@if(scene.vertex_extras)
struct VertexExtra {
    /// Object space; zero where there is no normal map. The bitangent is `w * cross(normal, tangent)`.
    tangent: vec4f,
    /// Four halves.
    color: vec2u,
    /// The second set of texture coordinates.
    uv: vec2f,
}

/// Vertices in the space of their mesh.
var<storage, read> vertices: array<Vertex>;
@if(scene.vertex_extras)
var<storage, read> vertex_extras: array<VertexExtra>;
var<storage, read> triangles: array<Triangle>;
var<storage, read> instances: array<Instance>;

/// A vertex as its triangle sees it.
struct Corner {
    position: vec3f,
    normal: vec3f,
    /// Both sets of texture coordinates; zw is 0 where no image uses the second.
    uv: vec4f,
    /// Multiplies the base colour and its opacity.
    @if(scene.vertex_colors) color: vec4f,
}

/// A triangle in world space. Its front is where its corners run counter-clockwise, mirrored instances included.
struct Face {
    corners: array<Corner, 3>,
    /// Unit length, out of the front; zero for a triangle without area.
    normal: vec3f,
    /// In m².
    area: f32,
    material: u32,
}

/// Most of what a triangle's place takes; where there is only one, all threads read the same.
fn to_world_of(instance: u32) -> mat4x3f {
    @if(scene.instances > 1) {
        return instances[instance].to_world;
    } @else {
        return instances[0].to_world;
    }
}

fn corner_position(vertex: u32, instance: u32) -> vec3f {
    return to_world_of(instance) * vec4f(vertices[vertex].position, 1.0);
}

/// Of a triangle's corners.
fn corner_positions(triangle: u32) -> array<vec3f, 3> {
    let t = triangles[triangle];
    let to_world = to_world_of(t.instance);
    return array(
        to_world * vec4f(vertices[t.a].position, 1.0),
        to_world * vec4f(vertices[t.b].position, 1.0),
        to_world * vec4f(vertices[t.c].position, 1.0),
    );
}

/// Both sets of texture coordinates.
fn corner_uv(vertex: u32) -> vec4f {
    var uv = vec4f(vertices[vertex].u, vertices[vertex].v, 0.0, 0.0);
    @if(scene.second_uv) {
        let second = vertex_extras[vertex].uv;
        uv = vec4f(uv.xy, second);
    }
    return uv;
}

@if(scene.vertex_colors)
fn corner_color(vertex: u32) -> vec4f {
    let halves = vertex_extras[vertex].color;
    return vec4f(unpack2x16float(halves.x), unpack2x16float(halves.y));
}

/// xyz: a unit vector, or zero where there is no normal map; w as in `VertexExtra`, for the world.
@if(scene.normal_mapped)
fn corner_tangent(vertex: u32, instance: u32) -> vec4f {
    let tangent = vertex_extras[vertex].tangent;
    let world = instances[instance].to_world * vec4f(tangent.xyz, 0.0);
    return vec4f(unit_or(world, vec3f(0.0)), tangent.w * instances[instance].flip);
}

fn corner_of(vertex: u32, instance: u32) -> Corner {
    let v = vertices[vertex];
    var corner: Corner;
    corner.position = instances[instance].to_world * vec4f(v.position, 1.0);
    corner.normal = unit_or(instances[instance].normal_to_world * v.normal, vec3f(0.0));
    corner.uv = corner_uv(vertex);
    @if(scene.vertex_colors) {
        corner.color = corner_color(vertex);
    }
    return corner;
}

fn face_of(triangle: u32) -> Face {
    let t = triangles[triangle];
    let a = corner_of(t.a, t.instance);
    let b = corner_of(t.b, t.instance);
    let c = corner_of(t.c, t.instance);
    let n = cross(b.position - a.position, c.position - a.position) * instances[t.instance].flip;
    let doubled = length(n);
    return Face(array<Corner, 3>(a, b, c), n / max(doubled, 1e-30), 0.5 * doubled, instances[t.instance].material);
}

/// The vertex that draw call vertex `index` stands for: three for each triangle, in order.
fn vertex_of(index: u32) -> u32 {
    let t = triangles[index / 3u];
    let corner = index % 3u;
    return select(select(t.c, t.b, corner == 1u), t.a, corner == 0u);
}
