// Time and memory of Embree's trees over a file of triangles, for scripts/embree.sh.
//   embree_build SCENE.tris THREADS ROUNDS
// The file: "TRIS", u32 version, vertices V, triangles T, V x 3 f32 positions, T x 3 u32 indices; little-endian.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <time.h>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

static void die(const char* message) { fprintf(stderr, "embree_build: %s\n", message); exit(1); }
static double seconds() { timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }

static std::atomic<int64_t> allocated{0};
static bool count_memory(void*, ssize_t bytes, bool) { allocated += bytes; return true; }

int main(int argc, char** argv) {
  if (argc < 4) die("usage: embree_build SCENE.tris THREADS ROUNDS");
  FILE* file = fopen(argv[1], "rb");
  char magic[4];
  uint32_t head[3];
  if (!file || fread(magic, 1, 4, file) != 4 || memcmp(magic, "TRIS", 4) || fread(head, 4, 3, file) != 3) die("no file of triangles");
  std::vector<float> positions(3ull * head[1]);
  std::vector<uint32_t> indices(3ull * head[2]);
  if (fread(positions.data(), 4, positions.size(), file) != positions.size() || fread(indices.data(), 4, indices.size(), file) != indices.size()) die("file too short");
  fclose(file);

  const char* names[] = {"medium", "high"};
  const RTCBuildQuality qualities[] = {RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH};
  std::vector<double> times[2];
  int64_t bytes[2] = {0, 0};
  RTCDevice device = rtcNewDevice((std::string("threads=") + argv[2]).c_str());
  if (!device) die("no Embree device");
  rtcSetDeviceMemoryMonitorFunction(device, count_memory, nullptr);
  for (int round = 0; round < atoi(argv[3]); round++)
    for (int q = 0; q < 2; q++) {
      RTCScene scene = rtcNewScene(device);
      rtcSetSceneBuildQuality(scene, qualities[q]);
      RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, head[1]), positions.data(), 4 * positions.size());
      memcpy(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, head[2]), indices.data(), 4 * indices.size());
      rtcCommitGeometry(mesh);
      rtcAttachGeometry(scene, mesh);
      rtcReleaseGeometry(mesh);
      int64_t before = allocated;  // the mesh's own buffers
      double start = seconds();
      rtcCommitScene(scene);
      times[q].push_back(1e3 * (seconds() - start));
      bytes[q] = allocated - before;  // what is kept: scratch memory is given back
      rtcReleaseScene(scene);
    }
  printf("{\"embree\": \"%s\", \"triangles\": %u, \"builds\": [", RTC_VERSION_STRING, head[2]);
  for (int q = 0; q < 2; q++) {
    std::sort(times[q].begin(), times[q].end());
    printf("%s{\"quality\": \"%s\", \"build_ms\": {\"median\": %.3f, \"min\": %.3f, \"max\": %.3f}, \"bytes\": %lld}", q ? ", " : "", names[q],
           times[q][times[q].size() / 2], times[q].front(), times[q].back(), (long long)bytes[q]);
  }
  printf("]}\n");
}
