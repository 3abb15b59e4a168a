// Second batch: chords that join the ends of the missed rays and find thin objects between them (spec §8). Twin of
// ambray_core::gather::thin. Included by gather.glsl.

// Chords end a little before the second end point (spec §5).
const float CHORD_END = 1.0 - 1e-4;

// One bit a ray of the first batch: whether it missed within the radius. Variables of the shader rather than parameters,
// which would be copied. A word will do without thin-object detection.
const uint MISSED_WORDS = THIN == THIN_OFF ? 1u : (SPP + 31u) / 32u;
uint missed_words[MISSED_WORDS];
uint missed_count;

void clear_missed() {
    missed_count = 0u;
    for (uint i = 0u; i < MISSED_WORDS; ++i) {
        missed_words[i] = 0u;
    }
}

void set_missed(uint j) {
    missed_count += 1u;
    missed_words[j >> 5] |= 1u << (j & 31u);
}

bool is_missed(uint j) {
    return (missed_words[j >> 5] >> (j & 31u) & 1u) != 0u;
}

// Edge factor of the cosine between the hit's normal and the line of sight from the point (spec §8.3).
float seen_edge_on(float e) {
    float x = clamp((e - 0.15) / 0.35, 0.0, 1.0);
    return 1.0 - x * x * (3.0 - 2.0 * x);
}

vec4 world_direction(ShadedPoint point, mat3 basis, uint j);

// Distance of the end points of missed rays: R (paper), R/2 (sheet: low sheets are found too).
vec3 chord_end(ShadedPoint point, mat3 basis, uint j) {
    float end = THIN == THIN_PAPER ? VIEW.gather.radius : 0.5 * VIEW.gather.radius;
    return point.position + world_direction(point, basis, j).xyz * end;
}

// The chord between the missed rays i and j; `q` and `partner` are their places among the missed ones.
void trace_chord(
    ShadedPoint point, mat3 basis, uint i, uint j, uint q, uint partner, inout ChordSums sums, inout Tally tally) {
    vec3 start = chord_end(point, basis, i);
    vec3 to_end = chord_end(point, basis, j) - start;
    float size = length(to_end);
    if (!(size > 0.0)) {
        return;
    }
    tally.chord_rays += 1u;
    Ray ray = Ray(start, CHORD_END * size, to_end / size, ray_seed(point.hash, SPP + q * SPP + partner));
    float blocked = 0.0;
    if (THIN == THIN_PAPER && NEAR_RADIANCE == NEAR_OFF) {
        // Visibility alone: any hit will do.
        blocked = trace_any(RAY_CHORD, ray) ? 1.0 : 0.0;
    } else {
        Hit hit = trace_closest(RAY_CHORD, ray);
        if (hit.instance != NONE) {
            vec3 from_point = ray.origin + hit.t * ray.direction - point.position;
            float d = length(from_point);
            blocked = THIN == THIN_PAPER ? 1.0 : 1.0 - measure(d);
            float weight = size / VIEW.gather.radius;
            if (NEAR_RADIANCE != NEAR_OFF || THIN_EDGE != 0u) {
                vec3 normal;
                vec3 radiance = hit_radiance(ray, hit, d * VIEW.gather.cone_width, tally, normal);
                if (THIN == THIN_SHEET) {
                    if (THIN_EDGE != 0u) {
                        blocked *= seen_edge_on(abs(dot(normal, from_point)) / d);
                    }
                    weight = blocked;
                }
                sums.weight += weight;
                sums.weighted += weight * radiance;
            }
        }
    }
    tally.chord_hits += blocked > 0.0 ? 1u : 0u;
    sums.blocked += THIN == THIN_PAPER ? size * blocked : blocked;
    sums.total += THIN == THIN_PAPER ? size : 0.0;
}

// All pairs of missed rays (spec §8.1).
void trace_paper(ShadedPoint point, mat3 basis, inout ChordSums sums, inout Tally tally) {
    uint q = 0u;
    for (uint i = 0u; i < SPP; ++i) {
        if (!is_missed(i)) {
            continue;
        }
        uint partner = q + 1u;
        for (uint j = i + 1u; j < SPP; ++j) {
            if (is_missed(j)) {
                trace_chord(point, basis, i, j, q, partner, sums, tally);
                partner += 1u;
            }
        }
        q += 1u;
    }
}

// The missed ray that follows `ray` by azimuth: `place` is its place in the order of a table, or the last azimuth.
// Sets of their own for each pixel have no table: the next one is found by a search.
uint next_by_azimuth(ShadedPoint point, inout uint place, inout float azimuth, uint ray) {
    if (SAMPLING == SAMPLING_INTERLEAVED || SAMPLING == SAMPLING_SAME) {
        Uints order = Uints(VIEW.gather.by_azimuth);
        uint first = SAMPLING == SAMPLING_SAME ? 0u : point.sample_set * SPP;
        uint j = order.at[first + place];
        while (!is_missed(j)) {
            place += 1u;
            j = order.at[first + place];
        }
        place += 1u;
        return j;
    }
    uint best = NONE;
    float best_azimuth = 2.0;
    for (uint j = 0u; j < SPP; ++j) {
        if (is_missed(j)) {
            float candidate = sample_direction(point.sample_set, point.hash, j).w;
            bool later = candidate > azimuth || (candidate == azimuth && ray != NONE && j > ray);
            if (later && candidate < best_azimuth) {
                best = j;
                best_azimuth = candidate;
            }
        }
    }
    azimuth = best_azimuth;
    return best;
}

// Opposite pairs by azimuth (spec §8.3).
void trace_sheet(ShadedPoint point, mat3 basis, inout ChordSums sums, inout Tally tally) {
    uint pairs = missed_count / 2u;
    uint place = 0u, opposite_place = 0u;
    float azimuth = -1.0, opposite_azimuth = -1.0;
    uint ray = NONE, opposite = NONE;
    for (uint q = 0u; q < pairs; ++q) {
        opposite = next_by_azimuth(point, opposite_place, opposite_azimuth, opposite);
    }
    for (uint q = 0u; q < pairs; ++q) {
        ray = next_by_azimuth(point, place, azimuth, ray);
        opposite = next_by_azimuth(point, opposite_place, opposite_azimuth, opposite);
        trace_chord(point, basis, ray, opposite, q, q + pairs, sums, tally);
    }
    sums.total = pairs > 0u ? float(SPP) : 0.0;
}

ChordSums trace_chords(ShadedPoint point, mat3 basis, inout Tally tally) {
    ChordSums sums = ChordSums(0.0, 0.0, 0.0, vec3(0.0));
    if (THIN == THIN_PAPER) {
        trace_paper(point, basis, sums, tally);
    } else {
        trace_sheet(point, basis, sums, tally);
    }
    return sums;
}
