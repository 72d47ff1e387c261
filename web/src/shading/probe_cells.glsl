// The tetrahedron between probes that holds a point, where the places of the probes are no grid. The C++ is src/probe/tetrahedra.cpp; web/src/probes/cells.ts says what the
// texels are.

uniform highp sampler2DArray u_probe_cells;
uniform bool u_probe_use_all;  // whether invalid probes count as well

const int k_cells_at = 7;
const int k_most_steps = 256;  // of a walk, which ends sooner but for rounding

vec4 cell_texel(int i) {
    ivec3 size = textureSize(u_probe_cells, 0);
    return texelFetch(u_probe_cells, ivec3(i % size.x, i / size.x, u_probe_use_all ? size.z - 1 : 0), 0);
}

/// Walks through the faces that have the place on their other side (Edelsbrunner 1990). Returns the cell that holds it, or the one behind the face where the walk leaves the hull.
/// weights: barycentric in that cell.
int walk(vec3 place, int cell, out bool outside, out vec4 weights) {
    outside = false;
    for (int i = 0; i < k_most_steps; ++i) {
        int at = k_cells_at + 5 * cell;
        vec4 origin = cell_texel(at), a = cell_texel(at + 1), b = cell_texel(at + 2), c = cell_texel(at + 3);
        vec3 q = place - origin.xyz, part = vec3(dot(a.xyz, q), dot(b.xyz, q), dot(c.xyz, q));
        weights = vec4(1.0 - part.x - part.y - part.z, part);
        if (!(min(min(weights.x, weights.y), min(weights.z, weights.w)) < 0.0)) return cell;
        int next = int(weights.x < 0.0 ? origin.w : weights.y < 0.0 ? a.w : weights.z < 0.0 ? b.w : c.w);
        if (next < 0) {
            outside = true;
            return cell;
        }
        cell = next;
    }
    return cell;
}

/// The nearest point of a triangle: Ericson 2005, "Real-Time Collision Detection", 5.1.5, by the region of the plane in which p lies.
vec3 closest_on_triangle(vec3 p, vec3 a, vec3 b, vec3 c) {
    vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    if (d3 >= 0.0 && d4 <= d3) return b;
    if (d6 >= 0.0 && d5 <= d6) return c;
    float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
    if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6));
    return (a * va + b * vb + c * vc) / (va + vb + vc);
}

vec3 nearest_on_hull(vec3 place, int hull, int faces) {
    vec3 found = place;
    float nearest = 1e30;
    for (int i = 0; i < faces; ++i) {
        int at = hull + 3 * i;
        vec3 close = closest_on_triangle(place, cell_texel(at).xyz, cell_texel(at + 1).xyz, cell_texel(at + 2).xyz), d = close - place;
        float away = dot(d, d);
        if (away >= nearest) continue;
        nearest = away;
        found = close;
    }
    return found;
}

/// The probes between which a point lies, and their weights.
void find_cell(vec3 point, out ivec4 probes, out vec4 weights) {
    vec4 centre = cell_texel(0), x = cell_texel(1), y = cell_texel(2), z = cell_texel(3), low = cell_texel(4), size = cell_texel(5);
    weights = vec4(1.0, 0.0, 0.0, 0.0);
    probes = ivec4(size.w);
    if (centre.w == 0.0) return;  // all probes stand at one point
    vec3 place = vec3(dot(x.xyz, point - centre.xyz), dot(y.xyz, point - centre.xyz), dot(z.xyz, point - centre.xyz)), bins = cell_texel(6).xyz;
    bool outside;
    int cell = 0;
    for (int i = 0; i < 2; ++i) {
        ivec3 bin = ivec3(clamp((place - low.xyz) / size.xyz, vec3(0.0), bins - 1.0));
        cell = walk(place, int(cell_texel(int(x.w) + bin.x + int(bins.x) * (bin.y + int(bins.y) * bin.z)).x), outside, weights);
        if (i > 0) break;
        if (outside) place = nearest_on_hull(place, int(y.w), int(z.w));
        // Below the flat tetrahedra behind the faces of the hull, on both sides of it alike.
        place *= 1.0 - 2e-5;
    }
    weights = max(weights, vec4(0.0));
    weights /= weights.x + weights.y + weights.z + weights.w;
    probes = ivec4(cell_texel(k_cells_at + 5 * cell + 4));
}
