// Rays against the scene's triangles, through the hierarchy that the engine builds; nearer children first.
//
// Positions are metres from `scene.center`. Records of 16 B, as the engine's `scene::bvh` documents them: a grid, nodes of
// up to eight children with boxes in bytes (Ylitie, Karras and Laine 2017), triangles. Triangles: Möller and Trumbore 1997,
// widened by a millionth of their edges, so that rays do not slip through between neighbours.
// Cost: 76 B for each node, 36 B for each triangle; a stack of 64 words.

@if(scene.masked) import lib/holes;
import lib/scene;

var<storage, read> bvh: array<vec4u>;

const BVH_ROOT: u32 = 2u;
const BVH_DEPTH: u32 = 32u;
/// Records of a node, of a triangle.
const BVH_NODE: u32 = 5u;
const BVH_TRIANGLE: u32 = 4u;
/// Triangles in a node's leaves.
const BVH_MOST: u32 = 24u;
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

/// Children of a node that a ray meets.
struct Children {
    /// Record of the first that is a node.
    first: u32,
    /// Which are nodes.
    nodes: u32,
    /// Nodes that are met, in the order of the ray: bit i is child `i ^ order`, high bits are near.
    met: u32,
    /// Record of the first triangle in its leaves.
    first_triangle: u32,
    /// Triangles of leaves that are met.
    triangles: u32,
}

/// Which of four children the ray meets.
fn meets(low: vec3u, high: vec3u, scale: vec3f, begin: vec3f, far: f32) -> vec4<bool> {
    let low_x = vec4f(unpack4xU8(low.x)) * scale.x + begin.x;
    let low_y = vec4f(unpack4xU8(low.y)) * scale.y + begin.y;
    let low_z = vec4f(unpack4xU8(low.z)) * scale.z + begin.z;
    let high_x = vec4f(unpack4xU8(high.x)) * scale.x + begin.x;
    let high_y = vec4f(unpack4xU8(high.y)) * scale.y + begin.y;
    let high_z = vec4f(unpack4xU8(high.z)) * scale.z + begin.z;
    let enter = max(max(min(low_x, high_x), min(low_y, high_y)), max(min(low_z, high_z), vec4f(0.0)));
    let leave = min(min(max(low_x, high_x), max(low_y, high_y)), min(max(low_z, high_z), vec4f(far)));
    // Rounding must not lose a ray that comes from far away (Ize 2013).
    return enter <= leave * 1.0000004;
}

fn children_of(node: u32, ray: Gridded, order: u32, far: f32) -> Children {
    let head = bvh[node];
    let second = bvh[node + 1u];
    let third = bvh[node + 2u];
    let fourth = bvh[node + 3u];
    let last = bvh[node + 4u].xyz;
    let corner = vec3f(vec3u(head.x, head.x >> 16u, head.y) & vec3u(0xffffu));
    let units = vec3f(vec3u(1u) << (vec3u(head.y >> 16u, head.y >> 20u, head.y >> 24u) & vec3u(15u)));
    let begin = corner * ray.scale + ray.begin;
    let scale = units * ray.scale;
    let early = meets(vec3u(second.z, third.z, fourth.z), vec3u(third.x, fourth.x, last.x), scale, begin, far);
    let late = meets(vec3u(second.w, third.w, fourth.w), vec3u(third.y, fourth.y, last.y), scale, begin, far);
    let bits = dot(select(vec4u(0u), vec4u(1u, 2u, 4u, 8u), early), vec4u(1u))
        | dot(select(vec4u(0u), vec4u(16u, 32u, 64u, 128u), late), vec4u(1u));
    var out = Children(head.z, last.z, 0u, head.w, 0u);
    for (var child = 0u; child < 8u; child++) {
        if (bits & (1u << child)) != 0u {
            let kind = (select(second.x, second.y, child >= 4u) >> (8u * (child & 3u))) & 255u;
            if kind == 128u {
                out.met |= 1u << (child ^ order);
            } else {
                out.triangles |= ((1u << (kind >> 5u)) - 1u) << (kind & 31u);
            }
        }
    }
    return out;
}

/// Directions with a zero component would give 0 · ∞.
fn inverse_of(direction: vec3f) -> vec3f {
    let size = max(abs(direction), vec3f(1e-20));
    return select(vec3f(-1.0), vec3f(1.0), direction >= vec3f(0.0)) / size;
}

@if(scene.masked)
fn open_at(record: u32, weights: vec2f) -> bool {
    let ids = vec3u(bvh[record].w, bvh[record + 1u].w, bvh[record + 2u].w);
    let material = instances[bvh[record + 3u].x].material;
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
    var order = 0u;
    var hit = out.hit;
    // Of a node: the first of its children that are nodes; those to be visited yet, and which are nodes.
    var first: array<u32, BVH_DEPTH>;
    var left: array<u32, BVH_DEPTH>;
    var height = 0u;
    // No record is visited twice, and each ray ends once.
    let records = 3u * (arrayLength(&bvh) + 1u);
    for (var step = 0u; step < records; step++) {
        if height == 0u {
            if turn < 3u && hit.record == NOTHING {
                out.free |= turn;
            }
            if turn < 1u && asked[0].far > 0.0 {
                turn = 1u;
                walked = asked[0];
            } else if turn < 2u && asked[1].far > 0.0 {
                turn = 2u;
                walked = asked[1];
            } else if turn < 3u && ray.far > 0.0 {
                turn = 3u;
                walked = ray;
            } else {
                break;
            }
            grid = gridded(walked.origin, walked.direction);
            let ahead = select(vec3u(0u), vec3u(4u, 2u, 1u), walked.direction >= vec3f(0.0));
            order = ahead.x | ahead.y | ahead.z;
            hit = Hit(walked.far, vec2f(0.0), NOTHING);
            first[0] = BVH_ROOT;
            left[0] = (1u << (8u + order)) | 1u;
            height = 1u;
        }
        let top = height - 1u;
        let waiting = left[top];
        let nearest = firstLeadingBit(waiting) - 8u;
        left[top] = waiting & ~(256u << nearest);
        let before = waiting & ((1u << (nearest ^ order)) - 1u);
        let node = first[top] + BVH_NODE * countOneBits(before);
        height -= select(0u, 1u, left[top] < 256u);
        let children = children_of(node, grid, order, hit.t);
        if children.met != 0u {
            first[height] = children.first;
            left[height] = (children.met << 8u) | children.nodes;
            height += 1u;
        }
        var triangles = children.triangles;
        for (var i = 0u; i < BVH_MOST && triangles != 0u; i++) {
            let record = children.first_triangle + BVH_TRIANGLE * firstTrailingBit(triangles);
            triangles &= triangles - 1u;
            let a = bitcast<vec3f>(bvh[record].xyz);
            let ab = bitcast<vec3f>(bvh[record + 1u].xyz) - a;
            let ac = bitcast<vec3f>(bvh[record + 2u].xyz) - a;
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
                    if (bvh[record + 3u].w & 1u) != 0u && open_at(record, vec2f(u, v)) {
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
    }
    if turn == 3u {
        out.hit = hit;
    }
    return out;
}
