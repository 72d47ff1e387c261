// The mean of the pictures so far, with one more: mean_n = mean_(n-1) + (x_n - mean_(n-1)) / n, which keeps its digits.

uniform sampler2D u_mean;
uniform sampler2D u_picture;
uniform float u_weight;  // 1 / n
in vec2 v_point;
out vec4 out_color;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 picture = texelFetch(u_picture, p, 0);
    if (any(isnan(picture)) || any(isinf(picture))) picture = vec4(0.0);
    vec4 mean = texelFetch(u_mean, p, 0);
    out_color = u_weight >= 1.0 ? picture : mean + (picture - mean) * u_weight;
}
