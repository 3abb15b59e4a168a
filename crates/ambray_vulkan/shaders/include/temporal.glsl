// Accumulation of ambient light over frames (spec §12). Twin of ambray_core::temporal.
#ifndef TEMPORAL_GLSL
#define TEMPORAL_GLSL

#include "acceptance.glsl"
#include "earlier.glsl"

// Filtered openness and near radiance, bent normal with the share M that may change, and frames that they are the mean of.
struct Mean {
    vec4 ambient;
    vec4 bent;
    float frames;
};

const Mean NO_MEAN = Mean(vec4(0.0), vec4(0.0), 0.0);

bool earlier_accepts(vec4 then, vec3 normal, float footprint, uint q) {
    vec4 other = Plane(TEMPORAL_VIEW.earlier.positions).at[q];
    return other.w < FAR && accepts(then, normal, footprint, other, Plane(TEMPORAL_VIEW.earlier.normals).at[q].xyz);
}

Mean earlier_mean(uint q) {
    return Mean(
        Plane(TEMPORAL_VIEW.earlier.ambient).at[q], Plane(TEMPORAL_VIEW.earlier.bent).at[q],
        Frames(TEMPORAL_VIEW.earlier.frames).at[q]);
}

// What was kept around the place of the point in the last frame, bilinear over the pixels that saw its surface.
Mean resampled(vec4 then, vec3 normal, float footprint) {
    // Behind the eye of a perspective camera.
    if (!(footprint > 0.0)) {
        return NO_MEAN;
    }
    vec2 size = vec2(VIEW.size);
    vec2 place = earlier_place(then.xyz, footprint);
    vec2 corner = floor(place);
    vec2 share = place - corner;
    Mean sum = NO_MEAN;
    float weight = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        vec2 step = vec2(float(i & 1u), float(i >> 1u));
        vec2 at = corner + step;
        if (!(all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, size)))) {
            continue;
        }
        uint q = uint(at.y) * VIEW.size.x + uint(at.x);
        if (earlier_accepts(then, normal, footprint, q)) {
            float k = (step.x > 0.0 ? share.x : 1.0 - share.x) * (step.y > 0.0 ? share.y : 1.0 - share.y);
            Mean mean = earlier_mean(q);
            sum.ambient += k * mean.ambient;
            sum.bent += k * mean.bent;
            sum.frames += k * mean.frames;
            weight += k;
        }
    }
    if (!(weight > 0.0)) {
        return NO_MEAN;
    }
    // Where part of the taps was not seen, the rest stands for less: frames are not divided by the weight.
    return Mean(sum.ambient / weight, sum.bent / weight, sum.frames);
}

// The mean `kept`, drawn to the frame `now` where something changes.
Mean drawn(Mean kept, Mean now) {
    float changing = max(kept.bent.w, now.bent.w);
    if (TEMPORAL_VIEW.scene_moved == 0u || !(changing > 0.0) || !(kept.frames > 0.0)) {
        return kept;
    }
    float open = kept.ambient.x;
    float drawn = clamp(open, now.ambient.x - TEMPORAL_VIEW.tolerance, now.ambient.x + TEMPORAL_VIEW.tolerance);
    drawn = clamp(drawn, 0.0, 1.0);
    // Near radiance goes with what is not open: I = Lt (1 - O).
    vec3 near = open < 1.0 ? kept.ambient.yzw * ((1.0 - drawn) / (1.0 - open)) : now.ambient.yzw;
    return Mean(vec4(drawn, near), kept.bent, kept.frames);
}

// Share of a mean that is still true, by the shares M of the mean and of the frame.
float confidence(float kept, float now) {
    if (TEMPORAL_VIEW.scene_moved == 0u) {
        return 1.0;
    }
    float difference = abs(now - kept) / (max(now, kept) + CHANGED_FLOOR);
    return clamp((CHANGED_MOST - difference) / (CHANGED_MOST - CHANGED_LEAST), 0.0, 1.0);
}

// Most frames of a mean.
float longest(bool is_still, float share) {
    float most = is_still ? LONGEST : MOVING;
    if (TEMPORAL_VIEW.scene_moved == 0u) {
        return most;
    }
    bool lit = SOURCE == SOURCE_LIT || SOURCE == SOURCE_LIT_UNSHADOWED;
    float changing = lit ? 1.0 : clamp(share / CHANGING_SHARE, 0.0, 1.0);
    return changing > 0.0 ? min(most, MOVING + (CHANGING - MOVING) * changing) : most;
}

// The mean of a pixel, which sees a surface at `position` with `normal`, with its values `now` of this frame.
Mean accumulated(uint pixel, vec3 position, vec3 normal, Mean now) {
    if (TEMPORAL_VIEW.has_earlier == 0u) {
        return now;
    }
    vec3 then_position = Plane(TEMPORAL_VIEW.then_positions).at[pixel].xyz;
    vec3 then_normal = Plane(TEMPORAL_VIEW.then_normals).at[pixel].xyz;
    vec2 depth = earlier_depth(then_position);
    vec4 then = vec4(then_position, depth.x);
    bool is_still = TEMPORAL_VIEW.camera_moved == 0u && then_position == position && then_normal == normal;
    Mean kept = NO_MEAN;
    if (!is_still) {
        kept = resampled(then, then_normal, depth.y);
    } else if (earlier_accepts(then, then_normal, depth.y, pixel)) {
        // No resampling, so nothing is lost.
        kept = earlier_mean(pixel);
    }
    kept = drawn(kept, now);
    float frames = confidence(kept.bent.w, now.bent.w) * kept.frames;
    frames = min(frames, longest(is_still, max(kept.bent.w, now.bent.w)));
    float share = 1.0 / (frames + 1.0);
    return Mean(
        kept.ambient + (now.ambient - kept.ambient) * share, kept.bent + (now.bent - kept.bent) * share, frames + 1.0);
}

// Keeps `mean` for the next frame; `guide` is position and depth, which is FAR where nothing is seen.
void keep(uint pixel, vec4 guide, vec3 normal, Mean mean) {
    Plane(TEMPORAL_VIEW.next.positions).at[pixel] = guide;
    Plane(TEMPORAL_VIEW.next.normals).at[pixel] = vec4(normal, 0.0);
    Plane(TEMPORAL_VIEW.next.ambient).at[pixel] = mean.ambient;
    Plane(TEMPORAL_VIEW.next.bent).at[pixel] = mean.bent;
    Frames(TEMPORAL_VIEW.next.frames).at[pixel] = mean.frames;
}

#endif
