// Draws the environment in another projection: each texel is the mean of 8 x 8 points, as in src/render/environment_map.cpp. Behind
// environment.glsl and projections.glsl.

uniform int u_projection;  // 2 lat-long, 3 sphere map, 4 and 5 the two halves of a dual paraboloid
in vec2 v_point;
out vec4 out_color;

vec3 direction_of(vec2 uv) {
    if (u_projection == 2) {
        float phi = (uv.x - 0.5) * k_turn, theta = uv.y * 0.5 * k_turn;
        return vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
    }
    if (u_projection == 3) return sphere_map_direction(uv);
    return paraboloid_direction(u_projection == 5, uv);
}

void main() {
    vec3 sum = vec3(0.0);
    vec2 corner = v_point - 0.5 * vec2(dFdx(v_point.x), dFdy(v_point.y));
    vec2 texel = vec2(dFdx(v_point.x), dFdy(v_point.y));
    for (int k = 0; k < 64; ++k) {
        vec2 uv = corner + texel * (vec2(float(k % 8), float(k / 8)) + 0.5) / 8.0;
        sum += textureLod(u_latlong, latlong_point(direction_of(uv)), 0.0).rgb;
    }
    out_color = vec4(sum / 64.0, 1.0);
}
