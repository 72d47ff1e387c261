// Two rooms with a wall between them and no door: what is seen in each direction is known, so that the truth is too. Behind map.glsl and probe_light.glsl.

uniform float u_wall;        // x of the middle of the wall, metres
uniform vec3 u_window;       // radiance of the frosted window: that of the environment behind it
uniform int u_what;
uniform vec3 u_point;
uniform vec3 u_facing;
uniform float u_face_size;   // texels, of what a probe captures
in vec2 v_point;
out vec4 out_color;

const vec3 k_rooms = vec3(6.0, 2.4, 3.0);
const float k_half_wall = 0.1;

bool in_wall(vec3 p) {
    return abs(p.x - u_wall) < k_half_wall;
}

/// How far the walls of a point's room are in a direction.
float wall_distance(vec3 p, vec3 d) {
    bool bright = p.x < u_wall;
    vec3 low = vec3(bright ? 0.0 : u_wall + k_half_wall, 0.0, 0.0), high = vec3(bright ? u_wall - k_half_wall : k_rooms.x, k_rooms.yz);
    vec3 t = (mix(low, high, greaterThan(d, vec3(0.0))) - p) / d;
    return min(d.x != 0.0 ? t.x : 1e30, min(d.y != 0.0 ? t.y : 1e30, d.z != 0.0 ? t.z : 1e30));
}

/// The radiance that arrives at a point: a room with a window to the environment, and a dark one.
vec3 room_light(vec3 p, vec3 d) {
    vec3 q = p + d * wall_distance(p, d);
    bool bright = p.x < u_wall;
    if (bright && q.x < 1e-3 && abs(q.z - 1.5) < 0.7 && abs(q.y - 1.4) < 0.6) return u_window;
    vec3 tint = q.y < 1e-3 ? vec3(0.6, 0.4, 0.25) : q.y > k_rooms.y - 1e-3 ? vec3(0.85) : q.z < 1e-3 ? vec3(0.75, 0.3, 0.25) : q.z > k_rooms.z - 1e-3 ? vec3(0.35, 0.6, 0.35) : vec3(0.7, 0.7, 0.75);
    vec3 squares = floor(2.0 * (q + 1e-3));
    float checker = mod(squares.x + squares.y + squares.z, 2.0) < 0.5 ? 1.0 : 0.55;
    vec3 window = q - vec3(0.0, 1.4, 1.5);
    return tint * checker * (bright ? 0.3 * u_window / (1.0 + 0.25 * dot(window, window)) : vec3(0.03));
}

/// E / pi by so many directions about the normal, as dense as the cosine, each turned by the golden angle from the one before.
vec3 true_diffuse(vec3 p, vec3 n, int count) {
    vec3 side = normalize(abs(n.y) < 0.9 ? cross(n, vec3(0.0, 1.0, 0.0)) : cross(n, vec3(1.0, 0.0, 0.0))), up = cross(side, n), sum = vec3(0.0);
    for (int i = 0; i < count; ++i) {
        float r2 = (float(i) + 0.5) / float(count), phi = 2.39996323 * float(i), r = sqrt(r2);
        sum += room_light(p, side * (r * cos(phi)) + up * (r * sin(phi)) + n * sqrt(1.0 - r2));
    }
    return sum / float(count);
}

/// The direction of a texel of a captured cube: docs/conventions.md. Rows are the faces of all probes, one below the other.
vec3 captured_direction(int face, vec2 st) {
    vec3 d[6] = vec3[6](vec3(1.0, -st.y, -st.x), vec3(-1.0, -st.y, st.x), vec3(st.x, 1.0, st.y), vec3(st.x, -1.0, -st.y), vec3(st.x, -st.y, 1.0), vec3(-st.x, -st.y, -1.0));
    return normalize(d[face]);
}

/// What a probe captures of a texel: its mean radiance, or the mean distance and the mean of its square.
vec4 captured(bool distances) {
    int size = int(u_face_size), row = int(gl_FragCoord.y), probe = row / (6 * size);
    vec2 texel = vec2(floor(gl_FragCoord.x), float(row % size));
    vec3 p = probe_position(probe);
    vec4 sum = vec4(0.0);
    if (in_wall(p)) return sum;
    for (int i = 0; i < 16; ++i) {
        vec3 d = captured_direction((row / size) % 6, 2.0 * (texel + (vec2(i & 3, i >> 2) + 0.5) / 4.0) / u_face_size - 1.0);
        float reach = wall_distance(p, d);
        sum += (distances ? vec4(reach, reach * reach, 0.0, 0.0) : vec4(room_light(p, d), 1.0)) / 16.0;
    }
    return sum;
}

/// The factors of the weight of one of the eight probes of the cell: trilinear, validity, Chebyshev's visibility, facing.
vec4 factors(int corner) {
    vec3 t = clamp((u_point - u_probe_origin) / u_probe_spacing, vec3(0.0), vec3(u_probe_counts - 1));
    ivec3 low = min(ivec3(t), u_probe_counts - 2), side = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2), place = low + side;
    vec3 along = mix(1.0 - (t - vec3(low)), t - vec3(low), vec3(side));
    int probe = place.x + u_probe_counts.x * (place.y + u_probe_counts.y * place.z);
    vec3 to_probe = probe_position(probe) - u_point;
    float reach = length(to_probe), facing = (1.0 + dot(to_probe, u_facing) / reach) / 2.0;
    return vec4(along.x * along.y * along.z, probe_valid(probe) ? 1.0 : 0.0, probe_visibility(probe, -to_probe, reach), facing * facing + 0.02);
}
float weight_of(int probe) {
    for (int i = 0; i < blend_count; ++i)
        if (blend_probes[i] == probe) return blend_weights[i];
    return 0.0;
}

void main() {
    if (u_what == 0 || u_what == 1) {  // the plan, seen from above: by the probes, and the truth
        vec3 p = vec3(v_point.x * k_rooms.x, u_point.y, (1.0 - v_point.y) * k_rooms.z);
        if (in_wall(p)) {
            out_color = vec4(vec3(0.35), 1.0);
            return;
        }
        if (u_what == 0) blend_at(p, u_facing);
        out_color = vec4(displayed(u_what == 0 ? domelight_diffuse(u_facing) : true_diffuse(p, u_facing, 200)), 1.0);
    } else if (u_what == 2 || u_what == 3) {  // a small mirror ball, seen from +Z: by the probes, and the truth
        vec2 q = 2.0 * v_point - 1.0;
        float r2 = dot(q, q);
        vec3 n = vec3(q, sqrt(max(0.0, 1.0 - r2))), r = reflect(vec3(0.0, 0.0, -1.0), n);
        if (u_what == 2) blend_at(u_point, n);
        out_color = vec4(displayed(u_what == 2 ? domelight_specular(r, 0.0) : room_light(u_point, r)), r2 < 1.0 ? 1.0 : 0.0);
    } else if (u_what == 4) {  // numbers of the point
        blend_at(u_point, u_facing);
        int column = int(gl_FragCoord.x), row = int(gl_FragCoord.y);
        out_color = row == 0 ? factors(column) : row == 1 ? vec4(column < u_probe_count ? weight_of(column) : 0.0) : column == 0 ? vec4(domelight_diffuse(u_facing), 1.0) : vec4(true_diffuse(u_point, u_facing, 1000), 1.0);
    } else {
        out_color = captured(u_what == 6);
    }
}
