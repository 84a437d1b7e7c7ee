// Rays against the scene's triangles, through the hierarchy that the engine builds; nearer child first.
//
// Positions are metres from `scene.center`. Records of 32 B, as the engine's `scene::bvh` documents them: a grid, inner
// nodes with boxes in 16 bits, triangles of two records. Triangles: Möller and Trumbore 1997, widened by a millionth of
// their edges, so that rays do not slip through between neighbours.
// Cost: 32 B for each node, 36 B for each triangle; a stack of 48 words.

@if(scene.masked) import lib/holes;
import lib/scene;

/// Two elements to a record.
var<storage, read> bvh: array<vec4u>;

const BVH_LEAF: u32 = 0x80000000u;
const BVH_DEPTH: u32 = 48u;
/// In place of a node: the walk is at its end. An empty leaf.
const BVH_ENDED: u32 = 0x80000000u;
const NOTHING: u32 = 0xffffffffu;

struct Hit {
    /// In units of the ray's direction.
    t: f32,
    /// Weights of the second and third corner.
    weights: vec2f,
    /// Record of the triangle, or NOTHING.
    record: u32,
}

/// A ray on the grid: the ray's parameter at step q of an axis is q * scale + begin.
struct Gridded {
    scale: vec3f,
    begin: vec3f,
}

fn gridded(origin: vec3f, direction: vec3f) -> Gridded {
    let inverse = inverse_of(direction);
    return Gridded(bitcast<vec3f>(bvh[1].xyz) * inverse, (bitcast<vec3f>(bvh[0].xyz) - origin) * inverse);
}

/// Where a ray enters the boxes of a node's children, x and y the first's begin and end.
fn children_of(xy: vec4u, z: vec2u, ray: Gridded, far: f32) -> vec4f {
    let low_x = vec2f(xy.xy & vec2u(0xffffu)) * ray.scale.x + ray.begin.x;
    let high_x = vec2f(xy.xy >> vec2u(16u)) * ray.scale.x + ray.begin.x;
    let low_y = vec2f(xy.zw & vec2u(0xffffu)) * ray.scale.y + ray.begin.y;
    let high_y = vec2f(xy.zw >> vec2u(16u)) * ray.scale.y + ray.begin.y;
    let low_z = vec2f(z & vec2u(0xffffu)) * ray.scale.z + ray.begin.z;
    let high_z = vec2f(z >> vec2u(16u)) * ray.scale.z + ray.begin.z;
    let begin = max(max(min(low_x, high_x), min(low_y, high_y)), max(min(low_z, high_z), vec2f(0.0)));
    let end = min(min(max(low_x, high_x), max(low_y, high_y)), min(max(low_z, high_z), vec2f(far)));
    // Rounding must not lose a ray that comes from far away (Ize 2013).
    return vec4f(begin.x, end.x * 1.0000004, begin.y, end.y * 1.0000004);
}

/// Directions with a zero component would give 0 · ∞.
fn inverse_of(direction: vec3f) -> vec3f {
    let size = max(abs(direction), vec3f(1e-20));
    return select(vec3f(-1.0), vec3f(1.0), direction >= vec3f(0.0)) / size;
}

@if(scene.masked)
fn open_at(record: u32, weights: vec2f) -> bool {
    let ids = vec3u(bvh[2u * record].w, bvh[2u * record + 1u].w, bvh[2u * record + 2u].w);
    let material = instances[bvh[2u * record + 3u].x].material;
    return hole_at(material, ids, vec3f(1.0 - weights.x - weights.y, weights));
}

/// A ray from `origin` to `far` times `direction`; none if `far` is 0.
struct Segment {
    origin: vec3f,
    direction: vec3f,
    far: f32,
}

struct Traced {
    hit: Hit,
    /// Bit i: nothing lies on the i-th of the rays that only ask.
    free: u32,
}

/// What `ray` meets first, and whether anything lies on two rays that only ask. Each thread walks one after another, so
/// that threads of a subgroup wait for each other once and not for each of the rays.
fn trace(asked: array<Segment, 2>, ray: Segment) -> Traced {
    var out = Traced(Hit(0.0, vec2f(0.0), NOTHING), 0u);
    // 1 and 2: the rays that ask, 3: the other.
    var turn = 0u;
    var walked: Segment;
    var grid: Gridded;
    var hit = out.hit;
    var stack: array<u32, BVH_DEPTH>;
    var height = 0u;
    var next = BVH_ENDED;
    // No record is visited twice, and each ray ends once.
    let records = 3u * (arrayLength(&bvh) / 2u + 1u);
    for (var leaf = 0u; leaf < records; leaf++) {
        if next == BVH_ENDED {
            if turn > 0u && hit.record == NOTHING {
                out.free |= turn;
            }
            if turn < 1u && asked[0].far > 0.0 {
                turn = 1u;
                walked = asked[0];
            } else if turn < 2u && asked[1].far > 0.0 {
                turn = 2u;
                walked = asked[1];
            } else if ray.far > 0.0 {
                turn = 3u;
                walked = ray;
            } else {
                break;
            }
            grid = gridded(walked.origin, walked.direction);
            hit = Hit(walked.far, vec2f(0.0), NOTHING);
            // The root is a node, after the grid.
            next = 1u;
        }
        // Down to a leaf.
        for (var node = 0u; node < records && (next & BVH_LEAF) == 0u; node++) {
            let rest = bvh[2u * next + 1u];
            let spans = children_of(bvh[2u * next], rest.xy, grid, hit.t);
            let children = rest.zw;
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
                next = BVH_ENDED;
            }
        }
        let begin = next & 0x07ffffffu;
        let end = begin + 2u * ((next >> 27u) & 15u);
        for (var record = begin; record < end; record += 2u) {
            let a = bitcast<vec3f>(bvh[2u * record].xyz);
            let ab = bitcast<vec3f>(bvh[2u * record + 1u].xyz) - a;
            let ac = bitcast<vec3f>(bvh[2u * record + 2u].xyz) - a;
            let p = cross(walked.direction, ac);
            let determinant = dot(ab, p);
            let scale = select(0.0, 1.0 / determinant, determinant != 0.0);
            let offset = walked.origin - a;
            let u = dot(offset, p) * scale;
            let q = cross(offset, ab);
            let v = dot(walked.direction, q) * scale;
            let t = dot(ac, q) * scale;
            if scale != 0.0 && min(u, v) >= -1e-6 && u + v <= 1.000001 && t > 0.0 && t < hit.t {
                @if(scene.masked) {
                    if (bvh[2u * record + 3u].w & 1u) != 0u && open_at(record, vec2f(u, v)) {
                        continue;
                    }
                }
                hit = Hit(t, vec2f(u, v), record);
                if turn < 3u {
                    height = 0u;
                    break;
                }
            }
        }
        if height == 0u {
            next = BVH_ENDED;
            if turn == 3u {
                break;
            }
        } else {
            height -= 1u;
            next = stack[height];
        }
    }
    if turn == 3u {
        out.hit = hit;
    }
    return out;
}
