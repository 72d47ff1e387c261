// The probes around a point and their weights: include/domelight/probe/probe_blend.h says what each factor is; the C++ is src/probe/probe_blend.cpp. Behind
// probe_visibility.glsl and probe_cells.glsl.

uniform int u_probe_most;            // how many are blended, 1 to 8
uniform bool u_probe_use_visibility;  // off: all probes of a cell count, as in engines that know no visibility

const int k_most_parts = 16;
const int k_nearest = 8;
const float k_enough = 0.02;  // the nearest probes begin to fill a blend whose weights sum to less

/// The blend at the point that is being lit.
vec3 blend_point;
int blend_count = 0;
int blend_probes[k_most_parts];
float blend_weights[k_most_parts];
float blend_sum = 0.0;

void add_part(int probe, float weight) {
    if (!(weight > 0.0)) return;
    blend_sum += weight;
    for (int i = 0; i < blend_count; ++i)
        if (blend_probes[i] == probe) {
            blend_weights[i] += weight;
            return;
        }
    blend_probes[blend_count] = probe;
    blend_weights[blend_count++] = weight;
}

/// 1 well inside of a probe's influence, falling to 0 at its boundary.
float influence_at(int probe, vec3 point) {
    vec4 shape = probe_record(probe, 2), low = probe_record(probe, 3);
    if (shape.w == 0.0) return 1.0;
    vec3 high = probe_record(probe, 4).xyz, inner = min(point - low.xyz, high - point);
    float inside = shape.w == 1.0 ? min(inner.x, min(inner.y, inner.z)) : low.x - length(point - probe_position(probe));
    return inside <= 0.0 ? 0.0 : inside >= low.w ? 1.0 : inside / low.w;
}

/// The product of all factors but the interpolation weight.
float importance(int probe, vec3 point, vec3 normal) {
    float weight = influence_at(probe, point);
    if (!u_probe_use_visibility || !(weight > 0.0)) return weight;
    if (!probe_valid(probe)) return 0.0;
    vec3 to_probe = probe_position(probe) - point;
    float reach = length(to_probe);
    if (!(reach > 0.0)) return weight;
    float facing = (1.0 + dot(to_probe, normal) / reach) / 2.0;
    return weight * (facing * facing + 0.02) * probe_visibility(probe, -to_probe, reach);
}

void add_grid_cell(vec3 point, vec3 normal) {
    vec3 t = clamp((point - u_probe_origin) / u_probe_spacing, vec3(0.0), vec3(u_probe_counts - 1));
    ivec3 low = min(ivec3(t), max(u_probe_counts - 2, ivec3(0))), high = min(low + 1, u_probe_counts - 1);
    vec3 part = t - vec3(low);
    for (int i = 0; i < 8; ++i) {
        ivec3 side = ivec3(i & 1, (i >> 1) & 1, i >> 2), place = low + side * (high - low);
        vec3 along = mix(1.0 - part, part, vec3(side));
        float weight = along.x * along.y * along.z;
        int probe = place.x + u_probe_counts.x * (place.y + u_probe_counts.y * place.z);
        if (weight > 0.0) add_part(probe, weight * importance(probe, point, normal));
    }
}

/// The distance of the second nearest probe that counts; 0 if fewer than three do.
float second_distance(vec3 point) {
    float nearest = 1e30, second = 1e30;
    int count = 0;
    for (int probe = 0; probe < u_probe_count; ++probe) {
        vec4 place = probe_record(probe, 0);
        if (!(place.w > 0.0 || u_probe_use_all)) continue;
        vec3 d = place.xyz - point;
        float square = dot(d, d);
        second = min(second, max(nearest, square));
        nearest = min(nearest, square);
        ++count;
    }
    return count > 2 ? sqrt(second) : 0.0;
}

void add_tetrahedron(vec3 point, vec3 normal) {
    ivec4 probes;
    vec4 weights;
    find_cell(point, probes, weights);
    // Tetrahedra at the hull can be long. Probes at more than twice the distance of the second nearest are too far.
    float second = second_distance(point), radius = 2.0 * second + 1e-6;
    for (int i = 0; i < 4; ++i) {
        if (!(weights[i] > 0.0)) continue;
        float part = second > 0.0 ? length(probe_position(probes[i]) - point) / radius : 0.0, closeness = part < 1.0 ? (1.0 - part * part) * (1.0 - part * part) : 0.0;
        if (closeness > 0.0) add_part(probes[i], weights[i] * closeness * importance(probes[i], point, normal));
    }
}

/// The nearest valid probes, where little weight is left because walls hide all the probes of a cell.
void add_nearest(vec3 point, vec3 normal) {
    int nearest[k_nearest + 1], found = 0;
    float away[k_nearest + 1];
    for (int probe = 0; probe < u_probe_count; ++probe) {
        vec4 place = probe_record(probe, 0);
        if (!(place.w > 0.0 || u_probe_use_all)) continue;
        vec3 d = place.xyz - point;
        float square = dot(d, d);
        if (found == k_nearest + 1 && !(square < away[k_nearest])) continue;
        int at = min(found, k_nearest);
        for (; at > 0 && square < away[at - 1]; --at) {
            away[at] = away[at - 1];
            nearest[at] = nearest[at - 1];
        }
        away[at] = square;
        nearest[at] = probe;
        found = min(found + 1, k_nearest + 1);
    }
    // A probe's weight falls to 0 where it stops to be one of the nearest: at the distance of the first one left out.
    float last = sqrt(away[found - 1]), radius = found > k_nearest ? last * 1.0001 + 1e-6 : 2.0 * last + 1e-6;
    float weights[k_nearest], total = 0.0, missing = k_enough - blend_sum;
    int count = min(found, k_nearest);
    for (int i = 0; i < count; ++i) {
        float part = 1.0 - sqrt(away[i]) / radius;
        // If no probe sees the point, the nearest ones count.
        weights[i] = part * part * (importance(nearest[i], point, normal) + 1e-5);
        total += weights[i];
    }
    for (int i = 0; i < count; ++i) add_part(nearest[i], missing * weights[i] / total);
}

/// Leaves only the u_probe_most largest weights, each less the largest of the others.
void keep_most() {
    if (blend_count <= u_probe_most) return;
    for (int i = 0; i <= u_probe_most; ++i) {
        int largest = i;
        for (int k = i + 1; k < blend_count; ++k)
            if (blend_weights[k] > blend_weights[largest]) largest = k;
        int probe = blend_probes[largest];
        float weight = blend_weights[largest];
        blend_probes[largest] = blend_probes[i];
        blend_weights[largest] = blend_weights[i];
        blend_probes[i] = probe;
        blend_weights[i] = weight;
    }
    float next = blend_weights[u_probe_most];
    int kept = 0;
    for (int i = 0; i < u_probe_most; ++i)
        if (blend_weights[i] > next) {
            blend_weights[i] -= next;
            ++kept;
        }
    blend_count = max(kept, 1);
}

void blend_at(vec3 point, vec3 normal) {
    blend_point = point;
    if (u_probe_grid) add_grid_cell(point, normal);
    else add_tetrahedron(point, normal);
    if (blend_sum < k_enough) add_nearest(point, normal);
    keep_most();
    float total = 0.0;
    for (int i = 0; i < blend_count; ++i) total += blend_weights[i];
    for (int i = 0; i < blend_count; ++i) blend_weights[i] /= total;
}
