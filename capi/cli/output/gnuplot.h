// Pictures by the program gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace brinell::cli {

/// Runs `script` twice, into `stem`.svg and `stem`.png; both appear complete or not at all. Throws FileError, also if
/// gnuplot is not installed.
void draw_picture(const std::filesystem::path& stem, const std::string& script);

/// A text as gnuplot reads it between single quotes.
std::string gnuplot_quoted(const std::string& text);

}  // namespace brinell::cli
