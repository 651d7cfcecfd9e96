// XDMF lists extents, origins and spacings slowest index first: z, y, x. A surface is a volume one node thick, which
// every reader places in space alike, whereas readers differ about two-dimensional grids.
#include <pugixml.hpp>
#include <sstream>

#include "formats/formats.h"
#include "output/fields_file.h"

namespace brinell::cli {

namespace {

constexpr std::array<const char*, 6> kComponents{"xx", "yy", "zz", "yz", "xz", "xy"};

std::string list(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + number_text(value);
  return text;
}

class Xdmf {
 public:
  Xdmf(const std::string& hdf5_name, const FieldsGrid& grid) : hdf5_name_(hdf5_name), grid_(grid) {
    auto root = document_.append_child("Xdmf");
    root.append_attribute("Version") = "2.0";
    domain_ = root.append_child("Domain");
  }

  /// A series over all increments of the fields on the surface, or of those below it.
  void add_series(const char* name, bool below, std::span<const StoredIncrement> increments) {
    auto series = domain_.append_child("Grid");
    series.append_attribute("Name") = name;
    series.append_attribute("GridType") = "Collection";
    series.append_attribute("CollectionType") = "Temporal";
    int time = 0;
    for (const auto& increment : increments) {
      const std::string group =
          "/step_" + std::to_string(increment.step) + "/increment_" + std::to_string(increment.increment);
      auto grid = series.append_child("Grid");
      grid.append_attribute("Name") = group.c_str() + 1;
      grid.append_attribute("GridType") = "Uniform";
      grid.append_child("Time").append_attribute("Value") = ++time;
      add_geometry(grid, below);
      for (const auto& field : increment.fields) {
        if ((field.kind != FieldKind::surface) == below) add_field(grid, field, group);
      }
    }
  }

  std::string text() const {
    std::ostringstream stream;
    document_.save(stream, "  ");
    return std::move(stream).str();
  }

 private:
  std::string extents(bool below) const {
    return std::to_string(below ? grid_.depths.size() : 1) + " " + std::to_string(grid_.ny) + " " +
           std::to_string(grid_.nx);
  }

  static pugi::xml_node add_item(pugi::xml_node parent, const std::string& dimensions, const std::string& text) {
    auto item = parent.append_child("DataItem");
    item.append_attribute("Dimensions") = dimensions.c_str();
    item.append_attribute("NumberType") = "Float";
    item.append_attribute("Precision") = 8;
    item.append_attribute("Format") = "XML";
    item.text() = text.c_str();
    return item;
  }

  bool evenly_spaced() const {
    const auto& depths = grid_.depths;
    if (depths.size() < 2) return true;
    const double step = (depths.back() - depths.front()) / static_cast<double>(depths.size() - 1);
    for (std::size_t k = 1; k < depths.size(); ++k) {
      if (std::abs(depths[k] - depths[k - 1] - step) > 1e-9 * step) return false;
    }
    return true;
  }

  void add_geometry(pugi::xml_node grid, bool below) const {
    const double x = -0.5 * static_cast<double>(grid_.nx - 1) * grid_.dx;
    const double y = -0.5 * static_cast<double>(grid_.ny - 1) * grid_.dy;
    auto topology = grid.append_child("Topology");
    auto geometry = grid.append_child("Geometry");
    const bool even = !below || evenly_spaced();
    topology.append_attribute("TopologyType") = even ? "3DCORECTMesh" : "3DRECTMesh";
    topology.append_attribute("Dimensions") = extents(below).c_str();
    geometry.append_attribute("GeometryType") = even ? "ORIGIN_DXDYDZ" : "VXVYVZ";
    if (even) {
      const auto& depths = grid_.depths;
      const double top = below ? depths.front() : 0;
      const double dz = below && depths.size() > 1 ? depths[1] - depths[0] : grid_.dx;
      add_item(geometry, "3", list({top, y, x}));
      add_item(geometry, "3", list({dz, grid_.dy, grid_.dx}));
      return;
    }
    add_item(geometry, std::to_string(grid_.nx), ladder(grid_.nx, x, grid_.dx));
    add_item(geometry, std::to_string(grid_.ny), ladder(grid_.ny, y, grid_.dy));
    std::string depths;
    for (const double depth : grid_.depths) depths += (depths.empty() ? "" : " ") + number_text(depth);
    add_item(geometry, std::to_string(grid_.depths.size()), depths);
  }

  static std::string ladder(std::int64_t count, double first, double step) {
    std::string text;
    for (std::int64_t k = 0; k < count; ++k) {
      text += (k == 0 ? "" : " ") + number_text(first + static_cast<double>(k) * step);
    }
    return text;
  }

  pugi::xml_node add_attribute(pugi::xml_node grid, const std::string& name, const char* type = "Scalar") const {
    auto attribute = grid.append_child("Attribute");
    attribute.append_attribute("Name") = name.c_str();
    attribute.append_attribute("AttributeType") = type;
    attribute.append_attribute("Center") = "Node";
    return attribute;
  }

  void add_reference(pugi::xml_node parent, const std::string& dimensions, const std::string& place) const {
    auto item = add_item(parent, dimensions, hdf5_name_ + ":" + place);
    item.attribute("Format") = "HDF";
  }

  void add_field(pugi::xml_node grid, const StoredField& field, const std::string& group) const {
    const std::string place = group + "/" + field.name;
    const std::string dimensions = extents(field.kind != FieldKind::surface);
    if (field.kind == FieldKind::surface || field.kind == FieldKind::scalar) {
      add_reference(add_attribute(grid, field.name), dimensions, place);
    } else if (field.kind == FieldKind::tensor) {
      for (std::size_t k = 0; k < kComponents.size(); ++k) {
        const auto attribute = add_attribute(grid, field.name + "_" + kComponents[k]);
        add_part(attribute, dimensions, k, 1, kComponents.size(), place);
      }
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto attribute = add_attribute(grid, field.name + "_" + std::to_string(k + 1), "Vector");
        add_part(attribute, dimensions, 3 * k, 3, 9, place);
      }
    }
  }

  /// `count` of the `all` numbers of each node, from the `first` on.
  void add_part(pugi::xml_node attribute, const std::string& dimensions, std::size_t first, std::size_t count,
                std::size_t all, const std::string& place) const {
    const std::string part = dimensions + " " + std::to_string(count);
    auto slab = attribute.append_child("DataItem");
    slab.append_attribute("ItemType") = "HyperSlab";
    slab.append_attribute("Dimensions") = part.c_str();
    auto selection = add_item(slab, "3 4", "0 0 0 " + std::to_string(first) + " 1 1 1 1 " + part);
    selection.attribute("NumberType") = "Int";
    add_reference(slab, dimensions + " " + std::to_string(all), place);
  }

  std::string hdf5_name_;
  const FieldsGrid& grid_;
  pugi::xml_document document_;
  pugi::xml_node domain_;
};

bool holds(std::span<const StoredIncrement> increments, bool below) {
  for (const auto& increment : increments) {
    for (const auto& field : increment.fields) {
      if ((field.kind != FieldKind::surface) == below) return true;
    }
  }
  return false;
}

}  // namespace

std::string xdmf_text(const std::string& hdf5_name, const FieldsGrid& grid,
                      std::span<const StoredIncrement> increments) {
  Xdmf xdmf(hdf5_name, grid);
  if (holds(increments, false)) xdmf.add_series("surface", false, increments);
  if (holds(increments, true)) xdmf.add_series("subsurface", true, increments);
  return xdmf.text();
}

}  // namespace brinell::cli
