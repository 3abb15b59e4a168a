// Entry of the ray generation shaders: the pass for one pixel, point or ray.

void main() {
    uvec2 pixel = push.origin + gl_LaunchIDEXT.xy;
    uint index = pixel.y * VIEW.size.x + pixel.x;
    if (index < VIEW.count) {
        run(pixel, index);
    }
}
