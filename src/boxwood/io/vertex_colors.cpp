#include "boxwood/io/vertex_colors.h"

namespace boxwood::io {

void show_vertex_colors(SceneDesc& desc) {
  Texture texture;
  texture.kind = Texture::Kind::vertex_color;
  texture.name = "colors of vertices";
  const TextureId colors = desc.add(texture);
  for (Material& material : desc.materials) {
    if (!material.color_texture.is_valid()) {
      material.color_texture = colors;
      continue;
    }
    Texture product;
    product.kind = Texture::Kind::product;
    product.name = desc.textures[material.color_texture.value].name;
    product.first.texture = material.color_texture;
    product.second.texture = colors;
    material.color_texture = desc.add(std::move(product));
  }

  // What has no material is as white as its vertices.
  MaterialId white;
  const auto give_material = [&](MaterialId& id) {
    if (id.is_valid()) return;
    if (!white.is_valid()) {
      Material material;
      material.color = {1, 1, 1};
      material.color_texture = colors;
      white = desc.add(std::move(material));
    }
    id = white;
  };
  for (Geometry& geometry : desc.geometries) {
    if (geometry.materials.empty()) give_material(geometry.material);
    for (MaterialId& id : geometry.materials) give_material(id);
  }
}

}  // namespace boxwood::io
