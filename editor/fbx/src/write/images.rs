//! Images in the file or next to it, and the textures that use them.

use super::losses::FbxLosses;
use super::names::UsedNames;
use super::node::{FbxNode, bytes_node, setting};
use super::scene::{ObjectId, SceneWriter};
use dragonfly_anim::data::{Filter, Image, TextureRef, TextureTransform, Wrap};
use dragonfly_anim::format::{ImageKind, OutputFile};

/// Names of the two sets of texture coordinates.
pub(super) const UV_SETS: [&str; 2] = ["UVMap", "UVMap2"];

/// An image of the file.
struct WrittenImage {
    video: ObjectId,
    file_name: String,
}

/// The images of a model; `None` for one that has neither bytes nor a name.
pub(super) struct WrittenImages(Vec<Option<WrittenImage>>);

/// Destination of the bytes of images.
pub(super) enum ImageTarget<'a> {
    /// Into the file.
    Embedded,
    /// Into files next to a file whose name without its extension is `stem`.
    Beside { stem: &'a str, files: Vec<OutputFile> },
}

impl<'a> ImageTarget<'a> {
    /// Returns a target without files.
    pub(super) fn beside(stem: &'a str) -> Self {
        Self::Beside { stem, files: Vec::new() }
    }

    /// Returns the files that are not in the file itself.
    pub(super) fn into_files(self) -> Vec<OutputFile> {
        match self {
            Self::Embedded => Vec::new(),
            Self::Beside { files, .. } => files,
        }
    }

    /// Stores the bytes of an image under a name. Returns its node where it is in the file.
    fn store(&mut self, name: &str, bytes: &[u8]) -> Option<FbxNode> {
        match self {
            Self::Embedded => Some(bytes_node("Content", bytes)),
            Self::Beside { files, .. } => {
                files.push(OutputFile { name: name.to_owned(), bytes: bytes.to_vec() });
                None
            }
        }
    }

    /// Returns the name that an image gets if no other one has it. Next to a file it begins with the name of that file, so that the images
    /// of several files in one folder do not replace each other.
    fn wanted(&self, file_name: String) -> String {
        let Self::Beside { stem, .. } = self else { return file_name };
        let begins = file_name.strip_prefix(stem).is_some_and(|rest| rest.starts_with(['_', '.']));
        if begins { file_name } else { format!("{stem}_{file_name}") }
    }
}

/// Returns the name of the file of an image.
fn file_name(image: &Image, number: usize) -> String {
    let path = image.file_name.as_deref().unwrap_or(&image.name).replace('\\', "/");
    let name = path.rsplit('/').next().unwrap_or_default().trim();
    let allowed = |character: char| !character.is_control() && !"\\/:*?\"<>|".contains(character);
    let name: String =
        name.chars().map(|character| if allowed(character) { character } else { '_' }).collect();
    let name = if name.is_empty() { format!("image {number}") } else { name };
    let Some(kind) = ImageKind::of(&image.mime) else { return name };
    let extensions = kind.extensions;
    let has = name
        .rsplit_once('.')
        .is_some_and(|(_, end)| extensions.iter().any(|own| end.eq_ignore_ascii_case(own)));
    if has { name } else { format!("{name}.{}", extensions[0]) }
}

/// Adds all images, and stores their bytes in the target.
pub(super) fn add_images(
    scene: &mut SceneWriter,
    images: &[Image],
    target: &mut ImageTarget<'_>,
    losses: &mut FbxLosses,
) -> WrittenImages {
    // Some file systems do not distinguish capitals.
    let mut used = UsedNames::without_capitals();
    let mut written = Vec::with_capacity(images.len());
    for (number, image) in images.iter().enumerate() {
        if image.bytes.is_empty() && image.file_name.is_none() {
            losses.add(format!("/images/{number}"), "the image has no bytes and is left out");
            written.push(None);
            continue;
        }
        let wanted = file_name(image, number);
        // An image without bytes is a file that is there already.
        let wanted = if image.bytes.is_empty() { wanted } else { target.wanted(wanted) };
        let at = wanted.rfind('.').unwrap_or(wanted.len());
        let file_name = used.unique(&wanted[..at], &wanted[at..]);
        let content = match &*image.bytes {
            [] => None,
            bytes => target.store(&file_name, bytes),
        };
        let properties = FbxNode::new("Properties70")
            .containing([setting("Path", "KString", "XRefUrl", "").with(file_name.as_str())]);
        let mut children = vec![
            FbxNode::new("Type").with("Clip"),
            properties,
            FbxNode::new("UseMipMap").with(0),
            FbxNode::new("Filename").with(file_name.as_str()),
            FbxNode::new("RelativeFilename").with(file_name.as_str()),
        ];
        children.extend(content);
        let video = scene.object("Video", &file_name, ("Video", "Clip"), children);
        written.push(Some(WrittenImage { video, file_name }));
    }
    WrittenImages(written)
}

impl WrittenImages {
    /// Adds a use of an image. `None` for an image that is not in the file.
    pub(super) fn add_texture(
        &self,
        scene: &mut SceneWriter,
        texture: &TextureRef,
        place: &str,
        losses: &mut FbxLosses,
    ) -> Option<ObjectId> {
        let Some(image) = self.0.get(texture.image as usize).and_then(Option::as_ref) else {
            losses.add(place, "the texture has no image and is left out");
            return None;
        };
        if texture.wrap.contains(&Wrap::MirroredRepeat) {
            losses.add(place, "a mirrored texture is repeated");
        }
        if texture.magnify == Filter::Nearest || texture.minify == Filter::Nearest || !texture.mip {
            losses.add(place, "filters of textures are not stored");
        }
        let set = UV_SETS.get(texture.set as usize).copied().unwrap_or(UV_SETS[0]);
        let clamps = |wrap: Wrap| i32::from(wrap == Wrap::ClampToEdge);
        let mut properties = vec![
            setting("UVSet", "KString", "", "").with(set),
            setting("UseMaterial", "bool", "", "").with(1),
            setting("WrapModeU", "enum", "", "").with(clamps(texture.wrap[0])),
            setting("WrapModeV", "enum", "", "").with(clamps(texture.wrap[1])),
        ];
        properties.extend(transform(&texture.transform, place, losses));
        let class = "Texture";
        let children = [
            FbxNode::new("Type").with("TextureVideoClip"),
            FbxNode::new("Version").with(202),
            FbxNode::new("TextureName").with(format!("{}\0\u{1}{class}", image.file_name)),
            FbxNode::new("Media").with(format!("{}\0\u{1}Video", image.file_name)),
            FbxNode::new("FileName").with(image.file_name.as_str()),
            FbxNode::new("RelativeFilename").with(image.file_name.as_str()),
            FbxNode::new("Properties70").containing(properties),
        ];
        let id = scene.object("Texture", &image.file_name, (class, ""), children);
        scene.connect(image.video, id);
        Some(id)
    }
}

/// Returns the properties of a transform of texture coordinates: the way from the texture to the coordinates, whose v points up.
fn transform(transform: &TextureTransform, place: &str, losses: &mut FbxLosses) -> Vec<FbxNode> {
    let (offset, scale) = (transform.offset.as_dvec2(), transform.scale.as_dvec2());
    if *transform == TextureTransform::IDENTITY {
        return Vec::new();
    }
    if transform.rotation != 0.0 || scale.x == 0.0 || scale.y == 0.0 {
        losses.add(place, "the rotation of a texture, and a scale of zero, are not stored");
        return Vec::new();
    }
    let vector = |name: &str, [x, y, z]: [f64; 3]| setting(name, "Vector", "", "A").with(x).with(y).with(z);
    let moved = [-offset.x / scale.x, -(1.0 - scale.y - offset.y) / scale.y, 0.0];
    vec![vector("Translation", moved), vector("Scaling", [1.0 / scale.x, 1.0 / scale.y, 1.0])]
}
