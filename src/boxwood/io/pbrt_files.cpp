#include "boxwood/io/pbrt_files.h"

#include <exception>
#include <map>

#include "boxwood/io/formats.h"
#include "boxwood/io/picture_cache.h"

namespace boxwood::io::pbrt {
namespace {

/// What stands in for a picture that is missing: the grey of a photographer's card, as bright as most scenes
/// are on average.
constexpr Vec3 kPlainGrey{0.18f, 0.18f, 0.18f};

void read_mesh(const MeshFile& file, SceneDesc& desc) {
  TriangleMesh mesh;
  try {
    mesh = read_ply_mesh(file.path);
    mesh.colors.clear();  // pbrt does not look at them
    bake(mesh, file.frame);
  } catch (const std::exception& error) {
    fail(file.place, std::string("the mesh cannot be used: ") + error.what());
  }
  desc.geometries[file.geometry.value].shapes = std::move(mesh);
}

/// Which textures some material shows in the end, by itself or in another.
std::vector<char> shown_textures(SceneDesc& desc) {
  std::vector<char> is_shown(desc.textures.size());
  for (Material& material : desc.materials)
    for_each_texture(material, [&](TextureId& id) {
      if (id.is_valid()) is_shown[id.value] = true;
    });
  for (std::size_t i = desc.textures.size(); i-- > 0;)
    if (is_shown[i])
      for (const Texture::Operand* part :
           {&desc.textures[i].first, &desc.textures[i].second, &desc.textures[i].amount})
        if (part->texture.is_valid()) is_shown[part->texture.value] = true;
  return is_shown;
}

/// Takes out the textures that no material shows; the others keep their order.
void drop_hidden_textures(SceneDesc& desc) {
  const std::vector<char> is_shown = shown_textures(desc);
  std::vector<TextureId> new_ids(desc.textures.size());
  std::vector<Texture> shown;
  for (std::size_t i = 0; i < desc.textures.size(); ++i) {
    if (!is_shown[i]) continue;
    new_ids[i] = TextureId(shown.size());
    shown.push_back(std::move(desc.textures[i]));
  }
  const auto rename = [&](TextureId& id) {
    if (id.is_valid()) id = new_ids[id.value];
  };
  for (Texture& texture : shown)
    for (Texture::Operand* part : {&texture.first, &texture.second, &texture.amount}) rename(part->texture);
  for (Material& material : desc.materials) for_each_texture(material, rename);
  desc.textures = std::move(shown);
}

}  // namespace

void read_files(SceneDesc& desc, std::span<const MeshFile> meshes, std::span<const Picture> pictures,
                Warnings& warnings, Executor& executor) {
  const std::vector<char> is_shown = shown_textures(desc);
  std::map<std::filesystem::path, std::size_t> place_of_file;
  std::vector<std::filesystem::path> paths;
  for (const Picture& picture : pictures)
    if (is_shown[picture.texture.value] && place_of_file.try_emplace(picture.path, paths.size()).second)
      paths.push_back(picture.path);

  // All files at once; what goes wrong is kept by file,
  // so that the message does not depend on who came first.
  const std::size_t mesh_count = meshes.size(), files = mesh_count + paths.size();
  std::vector<std::exception_ptr> errors(files);
  std::vector<Texture> found(paths.size());
  parallel_for(executor, 0, files, 1, [&](std::size_t i) {
    try {
      if (i < mesh_count)
        read_mesh(meshes[i], desc);
      else
        found[i - mesh_count] = open_texture(paths[i - mesh_count]);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (std::size_t i = 0; i < mesh_count; ++i)
    if (errors[i]) std::rethrow_exception(errors[i]);

  // Give each texture its picture; go on without those that cannot be read: they are grey.
  std::vector<char> is_missing(desc.textures.size());
  for (const Picture& picture : pictures) {
    if (!is_shown[picture.texture.value]) continue;
    const std::size_t place = place_of_file.at(picture.path);
    Texture& texture = desc.textures[picture.texture.value];
    if (errors[mesh_count + place]) {
      // In products and mixes, grey; elsewhere see below.
      texture.kind = Texture::Kind::product;
      texture.first.color = kPlainGrey;
      is_missing[picture.texture.value] = true;
      try {
        std::rethrow_exception(errors[mesh_count + place]);
      } catch (const std::exception& error) {
        warnings.once(picture.place,
                      std::string("the texture cannot be read (") + error.what() + "); plain grey stands in");
      }
      continue;
    }
    const Texture& file = found[place];
    texture.width = file.width;
    texture.height = file.height;
    texture.texels = file.texels;
    texture.source = file.source;
    texture.is_srgb = file.is_srgb && !picture.is_linear;
  }
  for (Material& material : desc.materials) {
    if (material.color_texture.is_valid() && is_missing[material.color_texture.value])
      material.color = material.color * kPlainGrey;
    for_each_texture(material, [&](TextureId& id) {
      if (id.is_valid() && is_missing[id.value]) id = {};
    });
  }
  drop_hidden_textures(desc);
}

}  // namespace boxwood::io::pbrt
