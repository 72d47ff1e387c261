// Places a model in the world. Normals are turned by the inverse transpose of the model's matrix, so that they stay perpendicular
// to the surface where it is stretched.

in vec3 position;
in vec3 normal;
#ifdef HAS_UV
in vec2 uv;
#endif
#ifdef HAS_UV1
in vec2 uv1;
#endif
#ifdef HAS_TANGENT
in vec4 tangent;
#endif
#ifdef HAS_COLOR
in vec4 color;
#endif

uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform mat3 u_normal_matrix;

out vec3 v_position;
out vec3 v_normal;
out vec2 v_uv;
out vec2 v_uv1;
out vec4 v_tangent;
out vec4 v_color;

void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    v_position = world.xyz;
    v_normal = u_normal_matrix * normal;
    v_uv = vec2(0.0);
    v_uv1 = vec2(0.0);
    v_tangent = vec4(0.0);
    v_color = vec4(1.0);
#ifdef HAS_UV
    v_uv = uv;
#endif
#ifdef HAS_UV1
    v_uv1 = uv1;
#endif
#ifdef HAS_TANGENT
    v_tangent = vec4(mat3(modelMatrix) * tangent.xyz, tangent.w * sign(determinant(mat3(modelMatrix))));
#endif
#ifdef HAS_COLOR
    v_color = color;
#endif
    gl_Position = projectionMatrix * viewMatrix * world;
}
