// Images from PNG files, with libpng.
#pragma once

#include <filesystem>

#include "core/base/image.h"

// 8-bit colour; grey and palettes are converted. Throws std::runtime_error that names the file.
vsgraphs::Image<vsgraphs::Rgb> read_colour(const std::filesystem::path& path);

// 16-bit grey, values as they stand in the file. Throws std::runtime_error that names the file.
vsgraphs::Image<std::uint16_t> read_depth(const std::filesystem::path& path);
