//! Longer texts of the help.

pub(super) const EXAMPLES: &str = "\
Examples:
  ambray                                       render the built-in atrium to ambray.png
  ambray render scene.glb -o picture.png       render a file
  ambray render scene.glb --preset draft --size 640x360
  ambray render scene.glb -o layers.exr --aov openness,depth,albedo
  ambray render atrium --camera-position 0,1.6,-3 --camera-target 0,1.5,0
  ambray render scene.glb --time 1.25 -o moment.png
  ambray render scene.glb --frames 0..120 --fps 24 -o out/frame_####.png
  ambray render scene.glb -o turn.mp4          the whole animation as a video, with ffmpeg (.gif without)
  ambray view scene.glb                        a window: turn the camera, tune the light, copy the command line
  ambray query scene.glb --points points.csv -o openness.csv
  ambray compare scene.glb                     a report: errors, times and pictures of nine methods
  ambray compare --paper                       the paper's figures, made again and measured
  ambray bench --frames 200 --json
  ambray bench scene.glb --rays rays           the speed of the tracer alone, on the rays of a frame
  ambray bench flock --animate                 what it costs to follow an animation
  ambray diff picture.exr truth.exr --measure flip --tolerance 0.05 -o error.png
  ambray info scene.glb                        what is in it: meshes, lights, cameras, animations
  ambray info --devices                        list the Vulkan devices

Exit codes: 0 done, 1 over the tolerance of ambray diff, 2 error, 130 interrupted.";

pub(super) const DIFF_NOTES: &str = "\
Measures, over all pixels and all channels of a layer:
  rmse, bias, p99, max       in the unit of the values; bias is the mean of PICTURE minus REFERENCE
  psnr                       decibel, for a peak of 1
  flip                       of what is seen at 67 pixels a degree, rounded to 8 bits (Andersson et al. 2020)
  ssim                       of what is seen, Gaussian window of 11 pixels (Wang et al. 2004)
  edge-rmse, flat-rmse       RMSE where REFERENCE steps by more than 0.08 from pixel to pixel, and elsewhere
Values of PNG are display values from 0 to 1. Values of OpenEXR are linear; FLIP and SSIM see colours with exposure and tone \
map of REFERENCE, openness as grey. Depths, normals, positions and indices have no PSNR, FLIP, SSIM and edges.

Equal infinities agree. Pixels that are infinite or not a number on one side alone are counted, left out of the numbers, and \
over every tolerance.

Exit codes: 0 within the tolerance, 1 over it, 2 error.
";

pub(super) const POINTS_HELP: &str = "\
Points in the scene: CSV columns x,y,z,nx,ny,nz and optionally class (0 to 15), with or without a header, or JSON \
lines {\"position\": [x,y,z], \"normal\": [x,y,z], \"class\": 0}; - is stdin";

pub(super) const PRECEDENCE: &str = "\
Which setting counts: a flag beats the settings file, which beats the preset, which beats the default. \
A --preset flag replaces the preset named in the settings file, but not the settings written out there. \
Of a flag given twice, the last one counts.";

pub(super) const RENDER_NOTES: &str = "\
How PNG shows the planes of --aov (OpenEXR holds the plain values):
  colours        exposure, tone map and sRGB, as the picture; the albedo by sRGB alone
  openness       grey, display value = value: 0 black, 1 white; other colours by --ramp, other ends by --range
  depth          the same from the nearest surface to the farthest; white where nothing is seen
  counts         the same from 0 to the largest count
  position       x, y, z as red, green, blue over the box of what is seen; black where nothing is seen
  normals        (n + 1)/2 as red, green, blue; black where nothing is seen
  indices        a colour of their own each; black where nothing is seen
  motion         to the right and down as red and green about grey, relative to the largest movement

A picture holds its settings: --settings picture.png makes it again, but for light accumulated over earlier frames.

Sequences:
  --frames 0..120 renders frames 0 to 119, 0..=120 also 120, 7 that one, 0..120:5 every fifth. Frame k shows the time \
k/fps, counted from --time if that is given. All frames have the same samples (--frame), so that nothing flickers that \
stands still; with --temporal on, frame k continues the sequence of samples as frame --frame + k, and light accumulates \
from the first frame on. With --hold-time all frames show the moment of --time, so that its light accumulates alone.
  In the name of OUT, one run of # is the number, with zeros up to the length of the run. The folder is made if only it is \
missing. All files of a frame appear together; Ctrl-C keeps those of finished frames.
  --resume keeps frames whose files are there, if they hold the same settings, scene, planes and version, and are not older \
than the scene file (other files that it refers to are not looked at). With --temporal on, the frames before a missing one \
are rendered again, not written.
  --json prints one object when all is done, with a list of the frames.

Videos:
  GIF needs nothing else: 256 colours a frame, up to 50 frames a second, beginnings of frames rounded to hundredths of a \
second, repeated for ever. MP4 (H.264, even sides), WebM (VP9) and animated WebP need ffmpeg on the path. Every so many \
frames (:STEP) are shown as much longer. The video appears when it is complete; Ctrl-C leaves none.

";

pub(super) const BENCH_NOTES: &str = "\
With --rays, threads trace the rays of a frame and do nothing else, tile by tile of 16 x 16 pixels:
  primary                    those of the camera
  ambient                    the first batch, closest hits
  chords-paper               the second batch of --thin paper, any hits
  chords-sheet               the second batch of --thin sheet, closest hits
Each is traced as the frame would, in packets or one by one, whichever turns out to be quicker (measured), in packets only, in \
the order of the frame (traced) or sorted by sample class and number of the ray (deinterleaved), and one by one \
(single, pixel), by each instruction set. Rates are millions of rays a second of the time that the \
busiest thread ran, medians over the rounds with the lowest and highest; other programs hardly matter to them.
  The triangles are those of the scene in world space. Those of masked and blended materials are left out of the files, while \
frames see them; --opaque takes them from both.

";

pub(super) const COMPARE_NOTES: &str = "\
Every method sees the same depth and normals, and is filtered as it was published. --method of ambray render takes the same names.

The truth is the mean of independent batches of 512 rays a pixel, each with its own scramble in every pixel, unfiltered, at least \
1024 rays. It is kept by the content of scene and settings, so that the next report of the same view begins at once.

Times are those of the method and its filter. Methods in screen space run on the processor, for which they were not made.

With --paper, figures are seen from where the built-in atrium or Khronos' Sponza shows what they are about; other scenes are \
seen through the camera that is asked for. The table is made at 1920x1080 unless --size says otherwise.

";

pub(super) const VIEW_NOTES: &str = "\
In the window, ? lists what hands and keys do. 'Copy as command line' gives the call of ambray render that makes the picture \
that is shown. Without options of settings it begins with the look of the last run. It needs a display; it draws with Vulkan where a graphics card renders, else with OpenGL.

Steps of --script; places and sizes are pixels of the window:
  wait                       until the final pictures are shown
  open PATH, drop PATH       open a scene; drop a file on the window
  set NAME VALUE             change a setting of the side that is edited
  side a|b                   edit that side
  compare off|split|difference
  divider SHARE              0 left to 1 right
  aov NAME                   show another plane
  overlays on|off            words, lines and messages over the picture
  frames COUNT               until the picture is the mean of so many frames, with temporal on
  resize WIDTH HEIGHT
  key KEY, type TEXT         F, ?, Ctrl+Z; text into a field
  move X Y, click X Y, double-click X Y, alt-click X Y, scroll X Y LINES
  drag X Y DX DY [left|middle|right]
  screenshot FILE.png        what is on the window
  turntable FILE FRAMES      begin to write a turn around the scene
  copy FILE                  the command line that renders the picture
  expect error TEXT          fail unless a message of an error holds the text
  expect no-error            fail if there is one
  quit                       close the window; the end of the script does, too
A step that fails ends the program with exit code 2 and names its line.

";
