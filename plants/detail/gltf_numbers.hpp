#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "core/require.hpp"

namespace sunfleck::detail {

// The numbers of an accessor, of one type.
class Numbers {
 public:
  Numbers(const tinygltf::Model& model, int index, const std::string& what) : what_(what) {
    require(index >= 0 && static_cast<std::size_t>(index) < model.accessors.size(), what + ": accessor", index,
            "one of the file's");
    accessor_ = &model.accessors[static_cast<std::size_t>(index)];
    if (accessor_->sparse.isSparse) throw InvalidInput(what + ": is a sparse accessor, which is not read");
    const int view_index = accessor_->bufferView;
    require(view_index >= 0 && static_cast<std::size_t>(view_index) < model.bufferViews.size(), what + ": bufferView",
            view_index, "one of the file's");
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
    require(view.buffer >= 0 && static_cast<std::size_t>(view.buffer) < model.buffers.size(), what + ": buffer",
            view.buffer, "one of the file's");
    const std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    const int component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor_->componentType));
    const int each = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor_->type));
    require(component > 0 && each > 0, what + ": type", accessor_->type, "one of glTF's");
    const std::size_t element = static_cast<std::size_t>(component) * static_cast<std::size_t>(each);
    stride_ = view.byteStride != 0 ? view.byteStride : element;
    const std::size_t count = accessor_->count;
    const bool fits = view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset &&
                      accessor_->byteOffset <= view.byteLength && stride_ >= element && stride_ <= 252 &&
                      (count == 0 || (element <= view.byteLength - accessor_->byteOffset &&
                                      (count - 1) <= (view.byteLength - accessor_->byteOffset - element) / stride_));
    require(fits, what + ": number of elements", count, "no more than its buffer holds");
    data_ = data.data() + view.byteOffset + accessor_->byteOffset;
  }

  std::size_t size() const { return accessor_->count; }

  void requireFloats(int type, const char* rule) const {
    require(accessor_->componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && accessor_->type == type, what_ + ": type",
            accessor_->componentType, rule);
  }

  void requireType(int type, const char* rule) const {
    require(accessor_->type == type, what_ + ": type", accessor_->type, rule);
  }

  float real(std::size_t element, std::size_t component) const {
    float value = 0.f;
    std::memcpy(&value, data_ + element * stride_ + component * sizeof value, sizeof value);
    return value;
  }

  // A float, or a whole number as its share of the largest, as texture coordinates may be.
  double share(std::size_t element, std::size_t component) const {
    const unsigned char* at = data_ + element * stride_;
    std::uint16_t narrow = 0;
    switch (accessor_->componentType) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return double{real(element, component)};
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return at[component] / 255.;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        std::memcpy(&narrow, at + component * sizeof narrow, sizeof narrow);
        return narrow / 65535.;
      default:
        require(false, what_ + ": type", accessor_->componentType, "float, or a byte or a short without sign");
        return 0.;
    }
  }

  std::uint32_t index(std::size_t element) const {
    const unsigned char* at = data_ + element * stride_;
    std::uint32_t wide = 0;
    std::uint16_t narrow = 0;
    switch (accessor_->componentType) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return *at;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        std::memcpy(&narrow, at, sizeof narrow);
        return narrow;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        std::memcpy(&wide, at, sizeof wide);
        return wide;
      default:
        require(false, what_ + ": type", accessor_->componentType, "of whole numbers, not negative");
        return 0;
    }
  }

 private:
  std::string what_;
  const tinygltf::Accessor* accessor_;
  const unsigned char* data_;
  std::size_t stride_;
};

}  // namespace sunfleck::detail
