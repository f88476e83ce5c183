//! Materials, checked pixel by pixel: masks, textures and their coordinates, vertex colors, Phong lighting, and
//! sides.

use dragonfly_anim::data::*;
use dragonfly_document::DecodedImage;
use dragonfly_kit::document::made;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{PictureSettings, Studio};
use glam::{Vec2, Vec3, Vec4};
use image::RgbaImage;

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];
const WHITE: [u8; 4] = [255; 4];
const NOTHING: [u8; 4] = [0; 4];
/// Centers of the four quarters of a sheet: upper left, upper right, lower left, lower right.
const QUARTERS: [Vec2; 4] =
    [Vec2::new(0.25, 0.25), Vec2::new(0.75, 0.25), Vec2::new(0.25, 0.75), Vec2::new(0.75, 0.75)];

/// Settings for a view from the front with a transparent background.
fn settings() -> PictureSettings {
    PictureSettings {
        pitch: 0.0,
        grid: false,
        background: Some([0; 4]),
        ..dragonfly_kit::picture::images::settings()
    }
}

/// Returns an image of four texels, rows from the top.
fn four(texels: [[u8; 4]; 4]) -> DecodedImage {
    DecodedImage { width: 2, height: 2, pixels: texels.concat() }
}

pub(crate) fn texture(transform: TextureTransform) -> TextureRef {
    TextureRef {
        image: 0,
        set: 0,
        wrap: [Wrap::Repeat; 2],
        magnify: Filter::Nearest,
        minify: Filter::Nearest,
        mip: false,
        transform,
    }
}

/// Returns a material with a base color and no lighting.
fn unlit(texture: Option<TextureRef>) -> Material {
    Material { base_color_texture: texture, unlit: true, ..Material::default() }
}

/// Returns the image of one primitive.
fn draw(
    studio: &mut Studio,
    primitive: Primitive,
    material: Material,
    images: Vec<DecodedImage>,
    settings: &PictureSettings,
) -> RgbaImage {
    let loaded = made::loaded(made::standing(vec![primitive], vec![material]), images);
    let picture = studio.render(&loaded, settings).unwrap();
    assert_eq!(studio.stage().device().errors(), 0);
    picture
}

/// Returns the pixel at `at` of a sheet with the same edges as the plain sheet; (0, 0) is its upper left.
fn pixel(studio: &mut Studio, picture: &RgbaImage, at: Vec2) -> [u8; 4] {
    let plain = draw(studio, made::sheet(), unlit(None), Vec::new(), &settings());
    let seen = plain.enumerate_pixels().filter(|(.., pixel)| pixel[3] == 255);
    let places: Vec<Vec2> = seen.map(|(x, y, _)| Vec2::new(x as f32, y as f32)).collect();
    let low = places.iter().copied().reduce(Vec2::min).unwrap();
    let high = places.iter().copied().reduce(Vec2::max).unwrap();
    assert!((high - low).min_element() > 40.0, "the sheet is too small to be measured");
    let place = (low + (high - low) * at).round();
    picture.get_pixel(place.x as u32, place.y as u32).0
}

fn quarters(studio: &mut Studio, picture: &RgbaImage) -> [[u8; 4]; 4] {
    QUARTERS.map(|at| pixel(studio, picture, at))
}

/// Returns the mean of the three colors, 0..255.
fn brightness(pixel: &image::Rgba<u8>) -> u32 {
    pixel.0[..3].iter().map(|&value| u32::from(value)).sum::<u32>() / 3
}

#[test]
fn a_mask_discards_pixels_below_its_threshold() {
    let Some(mut studio) = studio::studio() else { return };
    let image = four([RED, [0, 255, 0, 0], [0, 0, 255, 100], [255, 255, 255, 160]]);
    let mut under = |alpha_mode| {
        let material = Material { alpha_mode, ..unlit(Some(texture(TextureTransform::IDENTITY))) };
        let picture = draw(&mut studio, made::sheet(), material, vec![image.clone()], &settings());
        quarters(&mut studio, &picture)
    };
    assert_eq!(under(AlphaMode::Mask(0.5)), [RED, NOTHING, NOTHING, WHITE]);
    assert_eq!(under(AlphaMode::Mask(0.25)), [RED, NOTHING, BLUE, WHITE]);
    assert_eq!(under(AlphaMode::Mask(0.75)), [RED, NOTHING, NOTHING, NOTHING]);
    assert_eq!(under(AlphaMode::Opaque), [RED, GREEN, BLUE, WHITE], "opaque surfaces ignore alpha");
    let blended = under(AlphaMode::Blend).map(|pixel| pixel[3]);
    assert_eq!(blended, [255, 0, 100, 160]);
}

#[test]
fn surfaces_behind_a_mask_are_visible_through_its_holes() {
    let Some(mut studio) = studio::studio() else { return };
    let image = four([RED, [0, 255, 0, 0], [0, 0, 255, 100], WHITE]);
    let texture = Some(texture(TextureTransform::IDENTITY));
    let mask = Material { alpha_mode: AlphaMode::Mask(0.5), ..unlit(texture) };
    let yellow = Material { base_color: Vec4::new(1.0, 1.0, 0.0, 1.0), ..unlit(None) };
    let mut behind = made::sheet();
    behind.material = Some(1);
    behind.vertices.positions.iter_mut().for_each(|position| position.z = -0.01);
    let model = made::standing(vec![made::sheet(), behind], vec![mask, yellow]);
    let picture = studio.render(&made::loaded(model, vec![image]), &settings()).unwrap();
    const YELLOW: [u8; 4] = [255, 255, 0, 255];
    assert_eq!(quarters(&mut studio, &picture), [RED, YELLOW, YELLOW, WHITE]);
}

#[test]
fn texture_coordinates_are_scaled_then_rotated_then_translated() {
    let Some(mut studio) = studio::studio() else { return };
    let mut under = |offset: [f32; 2], degrees: f32, scale: [f32; 2]| {
        let rotation = degrees.to_radians();
        let transform = TextureTransform { offset: offset.into(), rotation, scale: scale.into() };
        let images = vec![four([RED, GREEN, BLUE, WHITE])];
        let picture = draw(&mut studio, made::sheet(), unlit(Some(texture(transform))), images, &settings());
        quarters(&mut studio, &picture)
    };
    assert_eq!(under([0.0, 0.0], 0.0, [1.0, 1.0]), [RED, GREEN, BLUE, WHITE]);
    assert_eq!(under([0.5, 0.0], 0.0, [1.0, 1.0]), [GREEN, RED, WHITE, BLUE], "half an image to the left");
    assert_eq!(under([0.0, 0.5], 0.0, [1.0, 1.0]), [BLUE, WHITE, RED, GREEN], "half an image upwards");
    assert_eq!(under([0.0, 0.0], 0.0, [0.4, 1.0]), [RED, RED, BLUE, BLUE], "the left part fills the sheet");
    // (u, v) becomes (v, -u): the extension rotates coordinates clockwise on a page whose v points down.
    assert_eq!(under([0.0, 0.0], 90.0, [1.0, 1.0]), [BLUE, RED, WHITE, GREEN], "turned about the origin");
    // (u, v) becomes (v + 0.5, 0.65 - 0.4 u).
    assert_eq!(under([0.5, 0.65], 90.0, [0.4, 1.0]), [WHITE, GREEN, BLUE, RED], "all three in their order");
}

#[test]
fn a_texture_may_use_the_second_set_of_coordinates() {
    let Some(mut studio) = studio::studio() else { return };
    let mut sheet = made::sheet();
    let first = sheet.vertices.texture_coordinates[0].clone();
    sheet.vertices.texture_coordinates[1] = first.iter().map(|at| Vec2::new(1.0 - at.x, at.y)).collect();
    for (set, expected) in [(0, [RED, GREEN, BLUE, WHITE]), (1, [GREEN, RED, WHITE, BLUE])] {
        let texture = TextureRef { set, ..texture(TextureTransform::IDENTITY) };
        let images = vec![four([RED, GREEN, BLUE, WHITE])];
        let picture = draw(&mut studio, sheet.clone(), unlit(Some(texture)), images, &settings());
        assert_eq!(quarters(&mut studio, &picture), expected, "set {set}");
    }
}

#[test]
fn vertex_colors_mix_in_linear_light_and_multiply_the_base_color() {
    let Some(mut studio) = studio::studio() else { return };
    let mut sheet = made::sheet();
    // In the order upper left, lower left, lower right, upper right.
    let (left, right) = (Vec4::new(1.0, 0.0, 0.5, 1.0), Vec4::new(0.0, 1.0, 0.5, 1.0));
    sheet.vertices.colors = vec![left, left, right, right];
    let material = Material { base_color: Vec4::new(1.0, 0.5, 1.0, 1.0), ..unlit(None) };
    let picture = draw(&mut studio, sheet, material, Vec::new(), &settings());
    for share in [0.25f32, 0.5, 0.75] {
        let found = pixel(&mut studio, &picture, Vec2::new(share, 0.5));
        let expected = [1.0 - share, 0.5 * share, 0.5].map(|light| {
            let encoded = 1.055 * light.powf(1.0 / 2.4) - 0.055;
            (encoded * 255.0).round() as u8
        });
        let off = (0..3).map(|index| found[index].abs_diff(expected[index])).max().unwrap();
        assert!(off <= 3, "{share}: {found:?} instead of {expected:?}");
    }
}

#[test]
fn phong_lighting_consists_of_ambient_and_diffuse_light_and_a_highlight() {
    let Some(mut studio) = studio::studio() else { return };
    let mut under = |ambient: f32, diffuse: f32, specular: f32, specular_power: f32| {
        let [ambient, diffuse, specular] = [ambient, diffuse, specular].map(Vec3::splat);
        let phong = Phong { ambient, diffuse, specular, specular_power };
        let base_color = Vec4::new(0.1, 0.5, 0.1, 1.0);
        let material = Material { phong, use_phong: true, ..made::paint(base_color) };
        let picture = draw(&mut studio, made::ball(), material, Vec::new(), &settings());
        picture.pixels().copied().filter(|pixel| pixel[3] == 255).collect::<Vec<_>>()
    };
    let brightest = |pixels: &[image::Rgba<u8>]| pixels.iter().map(brightness).max().unwrap();
    let darkest = |pixels: &[image::Rgba<u8>]| pixels.iter().map(brightness).min().unwrap();
    let lit = |pixels: &[image::Rgba<u8>]| pixels.iter().filter(|pixel| brightness(pixel) > 60).count();

    assert_eq!(brightest(&under(0.0, 0.0, 0.0, 16.0)), 0, "no light without any of the three");
    let ambient = under(0.5, 0.0, 0.0, 16.0);
    assert!(darkest(&ambient) > 20, "ambient light reaches every side: {}", darkest(&ambient));
    assert!(ambient.iter().all(|pixel| pixel[1] > pixel[0] + 20), "and has the surface's color");
    let diffuse = under(0.0, 0.8, 0.0, 16.0);
    assert!(brightest(&diffuse) > darkest(&diffuse) + 40, "diffuse light falls from somewhere");
    assert!(brightest(&under(0.0, 0.4, 0.0, 16.0)) < brightest(&diffuse), "less of it is darker");

    let [wide, narrow] = [under(0.0, 0.0, 0.8, 8.0), under(0.0, 0.0, 0.8, 80.0)];
    assert!(brightest(&wide) > 150 && brightest(&narrow) > 150, "both have a highlight");
    assert!(lit(&narrow) > 0 && lit(&narrow) * 3 < lit(&wide), "{} of {}", lit(&narrow), lit(&wide));
    let glint = narrow.iter().max_by_key(|pixel| brightness(pixel)).unwrap();
    assert!(glint[1].abs_diff(glint[0]) < 30, "a highlight has the light's color, not the surface's");
    let both = under(0.2, 0.8, 0.8, 80.0);
    assert!(brightest(&both) > brightest(&under(0.2, 0.8, 0.0, 80.0)) + 30, "it lies over the rest");
}

#[test]
fn a_back_face_of_a_double_sided_material_is_drawn_and_lit_like_the_front() {
    let Some(mut studio) = studio::studio() else { return };
    for alpha_mode in [AlphaMode::Opaque, AlphaMode::Mask(0.5), AlphaMode::Blend] {
        let mut from = |yaw: f32, double_sided| {
            let red = made::paint(Vec4::new(0.8, 0.2, 0.1, 0.9));
            let material = Material { double_sided, alpha_mode, ..red };
            let settings = PictureSettings { yaw, ..settings() };
            draw(&mut studio, made::sheet(), material, Vec::new(), &settings).get_pixel(80, 60).0
        };
        let behind = std::f32::consts::PI;
        assert_eq!(from(behind, false), NOTHING, "{alpha_mode:?}");
        let [front, both, back] = [from(0.0, false), from(0.0, true), from(behind, true)];
        assert!(front[0] > front[2] + 40, "{alpha_mode:?}: {front:?}");
        for other in [both, back] {
            let off = (0..4).map(|index| other[index].abs_diff(front[index])).max().unwrap();
            assert!(off <= 2, "{alpha_mode:?}: {other:?} instead of {front:?}");
        }
    }
}
