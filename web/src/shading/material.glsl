// A point of a surface, as all methods of shading read it.

struct Surface {
    vec3 position;
    vec3 normal;       // as lit (interpolated, normal-mapped), unit length, on the viewer's side
    vec3 diffuse;      // albedo of the diffuse layer: the base colour times 1 - metalness
    vec3 f0;           // of the specular layer, seen from straight above
    vec3 f90;          // and at grazing angles
    vec3 dielectric_f0;
    vec3 dielectric_f90;
    float roughness;
    float occlusion;   // 1: open
    float ior;
    bool front;
    bool unlit;
    vec3 emission;
    float opacity;
};
