#include "toml_table.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "errors.h"
#include "formats/formats.h"
#include "words.h"

namespace brinell::cli {

namespace {

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "an array";
    case toml::node_type::string: return "a text";
    case toml::node_type::integer: return "a whole number";
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "true or false";
    default: return "a date or time";
  }
}

/// As it would stand in the file.
std::string whole(const toml::node& node) {
  if (const auto* text = node.as_string()) return "\"" + **text + "\"";
  if (const auto* number = node.as_floating_point()) return number_text(**number);
  if (const auto* array = node.as_array()) {
    std::vector<std::string> parts;
    for (const auto& part : *array) parts.push_back(whole(part));
    return "[" + joined(parts) + "]";
  }
  std::ostringstream stream;
  node.visit([&](const auto& value) { stream << value; });
  return std::move(stream).str();
}

/// The same, cut to a readable length.
std::string shown(const toml::node& node) {
  std::string text = whole(node);
  constexpr std::size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
}

}  // namespace

TomlTable::TomlTable(const toml::table& table, std::string file_name, std::string label)
    : table_(table), file_name_(std::move(file_name)), label_(std::move(label)) {}

int TomlTable::line() const {
  return static_cast<int>(table_.source().begin.line);
}

int TomlTable::line_of(const std::string& key) const {
  for (const auto& [name, node] : table_) {
    if (name.str() == key) return static_cast<int>(name.source().begin.line);
  }
  return line();
}

void TomlTable::fail_at(int line, const std::string& text) const {
  throw SceneError(file_name_ + ":" + std::to_string(line) + ": " + (label_.empty() ? "" : label_ + ": ") + text);
}

void TomlTable::fail(const std::string& text) const {
  fail_at(line(), text);
}

void TomlTable::fail_key(const std::string& key, const std::string& text) const {
  const toml::node* node = table_.get(key);
  const bool is_value = node != nullptr && !node->is_table() && !node->is_array_of_tables();
  fail_at(line_of(key), key + (is_value ? " = " + shown(*node) : "") + ", " + text);
}

void TomlTable::fail_type(const std::string& key, const toml::node& node, const std::string& wanted) const {
  fail_key(key, "expected " + wanted + ", found " + type_name(node));
}

const toml::node* TomlTable::find(const std::string& key) {
  known_.insert(key);
  return table_.get(key);
}

double TomlTable::checked_number(const std::string& key, const toml::node& node, Allowed allowed) const {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) fail_type(key, node, "a number");
  if (!std::isfinite(*value)) fail_key(key, "expected a finite number");
  if (allowed == Allowed::positive && !(*value > 0)) fail_key(key, "expected above 0");
  if (allowed == Allowed::not_negative && *value < 0) fail_key(key, "expected at least 0");
  return *value;
}

std::int64_t TomlTable::checked_integer(const std::string& key, const toml::node& node, std::int64_t least,
                                        std::int64_t most) const {
  if (!node.is_integer()) fail_type(key, node, "a whole number");
  const std::int64_t value = **node.as_integer();
  if (value < least || value > most) {
    fail_key(key, "expected a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return value;
}

const toml::array& TomlTable::checked_array(const std::string& key, const toml::node& node, const std::string& wanted,
                                            std::size_t size) const {
  if (!node.is_array()) fail_type(key, node, wanted);
  const toml::array& array = *node.as_array();
  if (size != 0 && array.size() != size) {
    fail_key(key, "expected " + wanted + ", found " + std::to_string(array.size()) + " values");
  }
  return array;
}

std::optional<double> TomlTable::number(const std::string& key, Allowed allowed) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  return checked_number(key, *node, allowed);
}

std::optional<std::int64_t> TomlTable::integer(const std::string& key, std::int64_t least, std::int64_t most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  return checked_integer(key, *node, least, most);
}

std::optional<bool> TomlTable::boolean(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) fail_type(key, *node, "true or false");
  return **node->as_boolean();
}

std::optional<std::string> TomlTable::text(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) fail_type(key, *node, "a text in quotes");
  return **node->as_string();
}

std::optional<std::array<double, 2>> TomlTable::number_pair(const std::string& key, Allowed allowed) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array& array = checked_array(key, *node, "two numbers [x, y]", 2);
  return std::array{checked_number(key, array[0], allowed), checked_number(key, array[1], allowed)};
}

std::optional<std::array<std::int64_t, 2>> TomlTable::integer_pair(const std::string& key, std::int64_t least,
                                                                   std::int64_t most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array& array = checked_array(key, *node, "two whole numbers [x, y]", 2);
  return std::array{checked_integer(key, array[0], least, most), checked_integer(key, array[1], least, most)};
}

std::vector<double> TomlTable::numbers(const std::string& key, Allowed allowed) {
  std::vector<double> values;
  if (const toml::node* node = find(key)) {
    for (const auto& element : checked_array(key, *node, "an array of numbers", 0)) {
      values.push_back(checked_number(key, element, allowed));
    }
  }
  return values;
}

std::vector<std::array<double, 2>> TomlTable::number_pairs(const std::string& key) {
  std::vector<std::array<double, 2>> values;
  if (const toml::node* node = find(key)) {
    const std::string wanted = "an array of pairs [[a, b], ...]";
    for (const auto& element : checked_array(key, *node, wanted, 0)) {
      if (!element.is_array() || element.as_array()->size() != 2) fail_key(key, "expected " + wanted);
      const toml::array& pair = *element.as_array();
      values.push_back({checked_number(key, pair[0], Allowed::any), checked_number(key, pair[1], Allowed::any)});
    }
  }
  return values;
}

std::vector<std::string> TomlTable::texts(const std::string& key, const std::vector<std::string>& choices) {
  std::vector<std::string> values;
  if (const toml::node* node = find(key)) {
    for (const auto& element : checked_array(key, *node, "an array of texts", 0)) {
      if (!element.is_string()) fail_type(key, element, "an array of texts");
      values.push_back(**element.as_string());
      if (std::find(choices.begin(), choices.end(), values.back()) == choices.end()) {
        fail_key(key, "'" + values.back() + "' is unknown, the nearest is '" + nearest(values.back(), choices) +
                          "'; expected some of: " + joined(choices));
      }
    }
  }
  return values;
}

std::optional<std::string> TomlTable::choice(const std::string& key, const std::vector<std::string>& choices) {
  auto value = text(key);
  if (value && std::find(choices.begin(), choices.end(), *value) == choices.end()) {
    fail_key(key, "the nearest is '" + nearest(*value, choices) + "'; expected one of: " + joined(choices));
  }
  return value;
}

std::optional<TomlTable> TomlTable::table(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const std::string outer = label_.empty() ? "" : label_.substr(1, label_.size() - 2) + ".";
  const std::string label = "[" + outer + key + "]";
  if (!node->is_table()) fail_type(key, *node, "a table " + label);
  return TomlTable(*node->as_table(), file_name_, label);
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> list;
  if (const toml::node* node = find(key)) {
    const std::string label = "[[" + key + "]]";
    if (node->is_table()) fail_at(line_of(key), "found [" + key + "], expected " + label + ", there may be several");
    if (!node->is_array()) fail_type(key, *node, "tables " + label);
    for (const auto& element : *node->as_array()) {
      if (!element.is_table()) fail_type(key, element, "tables " + label);
      list.emplace_back(*element.as_table(), file_name_, label + " " + std::to_string(list.size() + 1));
    }
  }
  return list;
}

void TomlTable::finish() const {
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const auto& [name, node] : table_) {
    const std::string key(name.str());
    if (known_.contains(key)) continue;
    fail_at(line_of(key), "unknown key '" + key + "', the nearest known key is '" + nearest(key, known) +
                              "'; allowed here: " + joined(known));
  }
  if (!missing_.empty()) fail("the key " + missing_.front() + " is missing");
}

}  // namespace brinell::cli
