#include "png_image.h"

#include <png.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

namespace {

[[noreturn]] void fail(png_structp png, png_const_charp message) {  // libpng's C code lets exceptions through
  throw std::runtime_error(*static_cast<std::string*>(png_get_error_ptr(png)) + ": " + message);
}

void ignore(png_structp, png_const_charp) {}

class PngReader {
 public:
  PngReader(const std::filesystem::path& path, int transforms)
      : name_(path.string()), file_(std::fopen(name_.c_str(), "rb"), &std::fclose) {
    if (!file_) throw std::runtime_error("cannot read " + name_);
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &name_, fail, ignore);
    info_ = png_create_info_struct(png_);
    try {
      png_init_io(png_, file_.get());
      png_read_png(png_, info_, transforms, nullptr);
    } catch (...) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw;
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  template <typename T>
  vsgraphs::Image<T> image(int depth, int channels) const {
    if (png_get_bit_depth(png_, info_) != depth || png_get_channels(png_, info_) != channels)
      throw std::runtime_error(name_ + ": not an image of " + std::to_string(channels) + " x " +
                               std::to_string(depth) + " bits");
    vsgraphs::Image<T> image(static_cast<int>(png_get_image_width(png_, info_)),
                             static_cast<int>(png_get_image_height(png_, info_)));
    png_bytepp rows = png_get_rows(png_, info_);
    for (int v = 0; v < image.height; ++v)
      std::memcpy(&image.at(0, v), rows[v], sizeof(T) * static_cast<std::size_t>(image.width));
    return image;
  }

 private:
  std::string name_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

vsgraphs::Image<vsgraphs::Rgb> read_colour(const std::filesystem::path& path) {
  static_assert(sizeof(vsgraphs::Rgb) == 3);
  const PngReader reader(path, PNG_TRANSFORM_EXPAND | PNG_TRANSFORM_GRAY_TO_RGB | PNG_TRANSFORM_STRIP_ALPHA |
                                   PNG_TRANSFORM_STRIP_16);
  return reader.image<vsgraphs::Rgb>(8, 3);
}

vsgraphs::Image<std::uint16_t> read_depth(const std::filesystem::path& path) {
  const PngReader reader(path, PNG_TRANSFORM_SWAP_ENDIAN);  // the file's are big-endian
  return reader.image<std::uint16_t>(16, 1);
}
