// A set of probes as textures (web/src/probes/textures.ts): docs/probes.md.

uniform sampler2D u_probe_records;  // a row for each probe, columns as below
uniform int u_probe_count;
uniform bool u_probe_grid;          // whether the places are a grid:
uniform vec3 u_probe_origin;
uniform vec3 u_probe_spacing;
uniform ivec3 u_probe_counts;

uniform highp sampler2DArray u_probe_irradiance;  // web/src/probes/atlas.ts
uniform int u_probe_irradiance_size;

vec4 probe_record(int probe, int column) {
    return texelFetch(u_probe_records, ivec2(column, probe), 0);
}
vec3 probe_position(int probe) { return probe_record(probe, 0).xyz; }
bool probe_valid(int probe) { return probe_record(probe, 0).w > 0.0; }
bool probe_has_proxy(int probe) { return probe_record(probe, 1).w > 0.0; }

/// s and t of the face that a direction meets, both from -1 to 1, and the number of the face: docs/conventions.md.
vec3 face_point(vec3 d) {
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z) return d.x > 0.0 ? vec3(-d.z / a.x, -d.y / a.x, 0.0) : vec3(d.z / a.x, -d.y / a.x, 1.0);
    if (a.y >= a.z) return d.y > 0.0 ? vec3(d.x / a.y, d.z / a.y, 2.0) : vec3(d.x / a.y, -d.z / a.y, 3.0);
    return d.z > 0.0 ? vec3(d.x / a.z, -d.y / a.z, 4.0) : vec3(-d.x / a.z, -d.y / a.z, 5.0);
}

/// Bilinear. point: of face_point(); top: the row in which the level begins.
vec3 atlas_light(highp sampler2DArray atlas, int probe, vec3 point, float size, float top) {
    int face = int(point.z);
    vec2 corner = vec2(face % 3, face / 3) * (size + 2.0) + vec2(1.0, 1.0 + top), texel = corner + (point.xy * 0.5 + 0.5) * size;
    return textureLod(atlas, vec3(texel / vec2(textureSize(atlas, 0).xy), float(probe)), 0.0).rgb;
}

/// E / pi of one probe. point: face_point() of the normal.
vec3 probe_diffuse(int probe, vec3 point) {
    return atlas_light(u_probe_irradiance, probe, point, float(u_probe_irradiance_size), 0.0);
}
