#include "plants/detail/obj.hpp"

#include "plants/detail/assemble.hpp"
#include "plants/detail/input_file.hpp"
#include "plants/detail/obj_materials.hpp"

namespace sunfleck::detail {

ImportedTree readObj(const std::filesystem::path& path, std::string_view text, const ImportRules& rules,
                     const ImageReader& read_image) {
  const std::string source = shown(path.string());
  ObjFile file = parseObj(text, source);
  const ObjMaterials materials = readObjMaterials(path.parent_path(), file.material_files);
  for (Part& part : file.faces.parts) {
    if (const auto known = materials.colours.find(part.material); known != materials.colours.end())
      part.colour = known->second;
    if (const auto known = materials.opacities.find(part.material); known != materials.opacities.end())
      part.opacity = &known->second;
  }
  const Verdict verdict = tellApart(file.faces.parts, rules, source, materials.missing);
  ImportedTree tree = assemble(std::move(file.faces), verdict, rules, read_image, source);
  if (!materials.missing.empty()) tree.how += "; " + materials.missing;
  return tree;
}

}  // namespace sunfleck::detail
