// Five maps of one environment. Behind learn/common/map.glsl and web/src/shading/projections.glsl.

uniform int u_projection;  // 0 lat-long, 1 faces, 2 sphere map, 3 dual paraboloid side by side, 4 octahedral
uniform int u_what;        // 0 the picture, 1 the direction of u_point, 2 the points of u_direction in all of them
uniform vec2 u_point;
uniform vec3 u_direction;
in vec2 v_point;
out vec4 out_color;

vec3 direction_at(int projection, vec2 uv) {
    if (projection == 0) return latlong_direction(uv);
    if (projection == 1) return faces_direction(uv);
    if (projection == 2) return sphere_map_direction(uv);
    if (projection == 3) return paraboloid_direction(uv.x > 0.5, vec2(fract(2.0 * uv.x), uv.y));
    return octahedral_direction(uv);
}

vec2 point_of(int projection, vec3 d) {
    if (projection == 0) return latlong_point(d);
    if (projection == 1) return faces_uv(d);
    if (projection == 2) return sphere_map_uv(d);
    if (projection == 3) return vec2(0.5, 1.0) * paraboloid_uv(d.z < 0.0, d) + vec2(d.z < 0.0 ? 0.5 : 0.0, 0.0);
    return octahedral_uv(d);
}

/// Whether the map shows something at a point.
bool is_shown(int projection, vec2 uv) {
    vec2 disc = projection == 3 ? vec2(fract(2.0 * uv.x), uv.y) : uv;
    return projection < 2 || projection == 4 || length(disc_point(disc)) <= 1.0;
}

/// Solid angle of a unit of the picture's area, over 4π, by differences.
float spread(int projection, vec2 uv) {
    const float e = 0.002;
    vec3 across = direction_at(projection, uv + vec2(e, 0.0)) - direction_at(projection, uv - vec2(e, 0.0));
    vec3 down = direction_at(projection, uv + vec2(0.0, e)) - direction_at(projection, uv - vec2(0.0, e));
    return length(cross(across, down)) / (4.0 * e * e) / (2.0 * k_turn);
}

void main() {
    vec2 uv = vec2(v_point.x, 1.0 - v_point.y);
    int i = int(gl_FragCoord.x);
    if (u_what == 0) {
        out_color = is_shown(u_projection, uv) ? vec4(displayed(radiance_from(direction_at(u_projection, uv))), 1.0) : vec4(0.0);
    } else if (u_what == 1) {
        out_color = vec4(direction_at(u_projection, u_point), is_shown(u_projection, u_point) ? 1.0 : 0.0);
    } else {
        vec2 point = point_of(i, u_direction);
        out_color = vec4(point, spread(i, point), 1.0);
    }
}
