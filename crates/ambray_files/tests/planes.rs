//! Values of pictures are read as they were written, and damaged or forged files end in an error.
#![forbid(unsafe_code)]

use std::{fs, io::Cursor, path::PathBuf};

use ambray::{Aov, AovKind};
use ambray_files::planes::{Meaning, Planes};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer as Part,
    LayerAttributes, SmallVec, Text, WritableImage as _, f16,
};

fn read(bytes: &[u8]) -> Result<Planes, String> {
    let file = tempfile::NamedTempFile::new().expect("temporary file");
    fs::write(file.path(), bytes).expect("picture");
    Planes::read(file.path()).map_err(|error| format!("{error:#}"))
}

/// A PNG file of 3 × 2 pixels.
fn png(color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == png::ColorType::Indexed {
        encoder.set_palette(vec![0, 0, 0, 255, 51, 0]);
    }
    let mut writer = encoder.write_header().expect("a head");
    writer.write_image_data(data).expect("pixels");
    writer.finish().expect("an end");
    bytes
}

/// A part of an OpenEXR file of 3 × 2 pixels.
fn part(name: Option<&str>, channels: Vec<(&str, FlatSamples)>) -> Part<AnyChannels<FlatSamples>> {
    let channels: SmallVec<_> =
        channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
    let attributes = LayerAttributes { layer_name: name.map(Text::from), ..LayerAttributes::default() };
    Part::new((3, 2), attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels))
}

fn exr(parts: Vec<Part<AnyChannels<FlatSamples>>>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions((3, 2)));
    let image = Image { attributes, layer_data: parts.into_iter().collect::<SmallVec<[_; 2]>>() };
    image.write().to_buffered(&mut bytes).expect("an OpenEXR file");
    bytes.into_inner()
}

fn floats(first: f32) -> FlatSamples {
    FlatSamples::F32((0..6).map(|i| first + i as f32).collect())
}

#[test]
fn png_of_every_kind_is_read_as_display_values() {
    use png::{BitDepth, ColorType};
    let grey = read(&png(ColorType::Grayscale, BitDepth::Eight, &[0, 51, 102, 153, 204, 255])).unwrap();
    assert_eq!((grey.width, grey.height, grey.layers.len()), (3, 2, 1));
    let layer = grey.layer("picture").unwrap();
    assert_eq!((layer.meaning, layer.channels.join(" ")), (Meaning::Shown, "Y".to_owned()));
    assert_eq!(layer.values, [[0.0, 0.2, 0.4, 0.6, 0.8, 1.0]]);

    let deep: Vec<u8> = (0..18_u16).flat_map(|i| (i * 3855).to_be_bytes()).collect();
    let deep = read(&png(ColorType::Rgb, BitDepth::Sixteen, &deep)).unwrap();
    assert_eq!(deep.layers[0].values[1], [1.0, 4.0, 7.0, 10.0, 13.0, 16.0].map(|i| i * 3855.0 / 65535.0));

    // Bits of 0b101 and 0b010, each in a byte of its own.
    let bits = read(&png(ColorType::Grayscale, BitDepth::One, &[0b1010_0000, 0b0100_0000])).unwrap();
    assert_eq!(bits.layers[0].values, [[1.0, 0.0, 1.0, 0.0, 1.0, 0.0]]);

    let palette = read(&png(ColorType::Indexed, BitDepth::Eight, &[0, 1, 0, 1, 1, 1])).unwrap();
    assert_eq!(palette.layers[0].values[1], [0.0, 0.2, 0.0, 0.2, 0.2, 0.2]);

    let alpha = read(&png(ColorType::Rgba, BitDepth::Eight, &[[0, 51, 102, 255]; 6].concat())).unwrap();
    assert_eq!(alpha.layer("alpha").map(|layer| layer.values[0][5]), Some(1.0));
    assert_eq!(alpha.layers[0].values.iter().map(|v| v[0]).collect::<Vec<_>>(), [0.0, 0.2, 0.4]);
}

#[test]
fn exr_of_ambray_and_of_others_is_read_by_layers() {
    let ours = read(&exr(vec![part(
        None,
        vec![
            ("R", floats(0.0)),
            ("G", floats(10.0)),
            ("B", floats(20.0)),
            ("depth.Z", floats(f32::INFINITY)),
            ("bent-normal.Y", floats(1.0)),
            ("bent-normal.X", floats(0.0)),
            ("bent-normal.Z", floats(2.0)),
        ],
    )]))
    .unwrap();
    let names: Vec<_> = ours.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["beauty", "bent-normal", "depth"]);
    assert_eq!(ours.layers[0].values.iter().map(|v| v[0]).collect::<Vec<_>>(), [0.0, 10.0, 20.0]);
    assert_eq!(ours.layers[1].values.iter().map(|v| v[0]).collect::<Vec<_>>(), [0.0, 1.0, 2.0]);
    assert_eq!(ours.layers[2].meaning, Meaning::Plane(Aov::Depth));
    assert_eq!(ours.layers[2].values[0], [f32::INFINITY; 6]);

    let halves = FlatSamples::F16(vec![f16::from_f32(0.5); 6]);
    let theirs = read(&exr(vec![
        part(
            Some("diffuse"),
            vec![("R", halves), ("G", floats(1.0)), ("B", floats(2.0)), ("A", floats(0.0))],
        ),
        part(Some("ids"), vec![("id", FlatSamples::U32(vec![7; 6]))]),
    ]))
    .unwrap();
    let names: Vec<_> = theirs.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["diffuse", "diffuse.alpha", "ids"]);
    assert_eq!(theirs.layers[0].meaning.kind(), Some(AovKind::Color));
    assert_eq!((theirs.layers[0].values[0][0], theirs.layers[2].values[0][0]), (0.5, 7.0));
}

#[test]
fn what_is_no_picture_says_so() {
    assert!(read(b"").unwrap_err().ends_with("is neither PNG nor OpenEXR"));
    assert!(read(b"v 0 0 0\nf 1 1 1\n").unwrap_err().ends_with("is neither PNG nor OpenEXR"));
    let none = Planes::read(&PathBuf::from("none.png")).unwrap_err();
    assert!(format!("{none:#}").starts_with("picture none.png: "), "{none:#}");
    assert!(format!("{:#}", Planes::read(&PathBuf::from(".")).unwrap_err()).ends_with("is a folder"));
}

#[test]
fn forged_sizes_are_refused_before_memory_is_taken() {
    let mut forged = png(png::ColorType::Rgb, png::BitDepth::Sixteen, &[0; 36]);
    // Width and height stand behind the signature and the name of the first chunk; its checksum follows 13 bytes of data.
    forged[16..20].copy_from_slice(&0x7FFF_0000_u32.to_be_bytes());
    forged[20..24].copy_from_slice(&0x0000_FFFF_u32.to_be_bytes());
    let checksum = crc(&forged[12..29]);
    forged[29..33].copy_from_slice(&checksum.to_be_bytes());
    let error = read(&forged).unwrap_err();
    assert!(error.contains("cannot hold") || error.contains("imits"), "{error}");

    let mut forged = exr(vec![part(None, vec![("Y", floats(0.0))])]);
    // The data window: its name, its type, its size, then the corners as integers.
    let name = b"dataWindow\0box2i\0\x10\0\0\0";
    let at =
        forged.windows(name.len()).position(|window| window == name).expect("a data window") + name.len();
    for (i, corner) in [0, 0, 1_000_000, 1_000_000_i32].into_iter().enumerate() {
        forged[at + 4 * i..][..4].copy_from_slice(&corner.to_le_bytes());
    }
    let error = read(&forged).unwrap_err();
    assert!(error.contains("1000001x1000001 pixels with 1 values each, which a file of"), "{error}");
}

/// The checksum of chunks (PNG specification, annex D).
fn crc(bytes: &[u8]) -> u32 {
    let fold = |crc: u32| (0..8).fold(crc, |c, _| if c & 1 == 1 { 0xEDB8_8320 ^ (c >> 1) } else { c >> 1 });
    !bytes.iter().fold(u32::MAX, |crc, &byte| (crc >> 8) ^ fold((crc ^ u32::from(byte)) & 0xFF))
}

#[test]
fn damaged_files_end_in_an_error_or_in_values_and_never_in_a_panic() {
    let mut random = fastrand::Rng::with_seed(5);
    let files = [
        png(png::ColorType::Rgba, png::BitDepth::Sixteen, &(0..48).collect::<Vec<u8>>()),
        exr(vec![part(None, vec![("R", floats(0.0)), ("depth.Z", floats(1.0))])]),
        exr(vec![part(Some("a"), vec![("Y", floats(0.0))]), part(Some("b"), vec![("Y", floats(1.0))])]),
    ];
    let mut refused = 0;
    for file in &files {
        assert!(read(file).is_ok());
        for cut in (0..file.len()).step_by(7) {
            assert!(read(&file[..cut]).is_err(), "{cut} of {} bytes were enough", file.len());
        }
        for _ in 0..500 {
            let mut damaged = file.clone();
            for _ in 0..random.usize(1..4) {
                let at = random.usize(..damaged.len());
                damaged[at] = random.u8(..);
            }
            refused += usize::from(read(&damaged).is_err());
        }
    }
    assert!(refused > 500, "only {refused} were noticed");
}
