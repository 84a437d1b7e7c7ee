// Rays against the scene's triangles, through the hierarchy that the engine builds; nearer child first.
//
// Positions are metres from `scene.center`. Records of 64 B, inner nodes and triangles alike, as the engine's `scene::bvh`
// documents them. Triangles: Möller and Trumbore 1997, widened by a millionth of their edges, so that rays do not
// slip through between neighbours.
// Cost: 64 B for each node and triangle; a stack of 48 words.

@if(scene.masked) import lib/holes;
import lib/scene;

/// Four elements to a record.
var<storage, read> bvh: array<vec4u>;

const BVH_LEAF: u32 = 0x80000000u;
const BVH_DEPTH: u32 = 48u;
const NOTHING: u32 = 0xffffffffu;

struct Hit {
    /// In units of the ray's direction.
    t: f32,
    /// Weights of the second and third corner.
    weights: vec2f,
    /// Record of the triangle, or NOTHING.
    record: u32,
}

/// Where a ray enters the boxes of a node's children, x and y the first's begin and end.
fn children_of(node: u32, origin: vec3f, inverse: vec3f, far: f32) -> vec4f {
    let x = (bitcast<vec4f>(bvh[4u * node]) - origin.x) * inverse.x;
    let y = (bitcast<vec4f>(bvh[4u * node + 1u]) - origin.y) * inverse.y;
    let z = (bitcast<vec4f>(bvh[4u * node + 2u]) - origin.z) * inverse.z;
    let begin = max(max(min(x.xz, x.yw), min(y.xz, y.yw)), max(min(z.xz, z.yw), vec2f(0.0)));
    let end = min(min(max(x.xz, x.yw), max(y.xz, y.yw)), min(max(z.xz, z.yw), vec2f(far)));
    // Rounding must not lose a ray that grazes (Ize 2013).
    return vec4f(begin.x, end.x * 1.0000004, begin.y, end.y * 1.0000004);
}

/// Directions with a zero component would give 0 · ∞.
fn inverse_of(direction: vec3f) -> vec3f {
    let size = max(abs(direction), vec3f(1e-20));
    return select(vec3f(-1.0), vec3f(1.0), direction >= vec3f(0.0)) / size;
}

@if(scene.masked)
fn open_at(record: u32, weights: vec2f) -> bool {
    let ids = vec3u(bvh[4u * record].w, bvh[4u * record + 1u].w, bvh[4u * record + 2u].w);
    let material = instances[bvh[4u * record + 3u].x].material;
    return hole_at(material, ids, vec3f(1.0 - weights.x - weights.y, weights));
}

/// What a ray meets before `far`: the nearest triangle, or if `early` is set the first that is found.
fn trace(origin: vec3f, direction: vec3f, far: f32, early: bool) -> Hit {
    var hit = Hit(far, vec2f(0.0), NOTHING);
    let inverse = inverse_of(direction);
    var stack: array<u32, BVH_DEPTH>;
    var height = 0u;
    // The root is a node.
    var next = 0u;
    loop {
        // Down to a leaf.
        while (next & BVH_LEAF) == 0u {
            let spans = children_of(next, origin, inverse, hit.t);
            let children = bvh[4u * next + 3u].xy;
            let first = spans.x <= spans.y;
            let second = spans.z <= spans.w;
            if first && second {
                let swap = spans.z < spans.x;
                stack[height] = select(children.y, children.x, swap);
                height += 1u;
                next = select(children.x, children.y, swap);
            } else if first || second {
                next = select(children.y, children.x, first);
            } else if height > 0u {
                height -= 1u;
                next = stack[height];
            } else {
                return hit;
            }
        }
        let begin = next & 0x07ffffffu;
        let end = begin + ((next >> 27u) & 15u);
        for (var record = begin; record < end; record++) {
            let a = bitcast<vec3f>(bvh[4u * record].xyz);
            let ab = bitcast<vec3f>(bvh[4u * record + 1u].xyz) - a;
            let ac = bitcast<vec3f>(bvh[4u * record + 2u].xyz) - a;
            let p = cross(direction, ac);
            let determinant = dot(ab, p);
            let scale = select(0.0, 1.0 / determinant, determinant != 0.0);
            let offset = origin - a;
            let u = dot(offset, p) * scale;
            let q = cross(offset, ab);
            let v = dot(direction, q) * scale;
            let t = dot(ac, q) * scale;
            if scale != 0.0 && min(u, v) >= -1e-6 && u + v <= 1.000001 && t > 0.0 && t < hit.t {
                @if(scene.masked) {
                    if (bvh[4u * record + 3u].w & 1u) != 0u && open_at(record, vec2f(u, v)) {
                        continue;
                    }
                }
                hit = Hit(t, vec2f(u, v), record);
                if early {
                    return hit;
                }
            }
        }
        if height == 0u {
            return hit;
        }
        height -= 1u;
        next = stack[height];
    }
    return hit;
}
