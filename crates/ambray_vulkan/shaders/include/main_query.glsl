// Entry of the compute shaders that trace: the pass for one pixel, point or ray.

void main() {
    uvec2 pixel = push.origin + gl_GlobalInvocationID.xy;
    uint index = pixel.y * VIEW.size.x + pixel.x;
    if (all(lessThan(gl_GlobalInvocationID.xy, push.extent)) && index < VIEW.count) {
        run(pixel, index);
    }
}
