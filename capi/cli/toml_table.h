// Reads one table of a TOML file key by key, and refuses what it was not asked for.
//
// Every message has the form  scene.toml:31: [[step]] 2: normal_force = -1.0, expected at least 0.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace brinell::cli {

/// What a number may be.
enum class Allowed { any, positive, not_negative };

class TomlTable {
 public:
  /// `label` names the table for a person: "[grid]", "[[step]] 2".
  TomlTable(const toml::table& table, std::string file_name, std::string label);

  bool has(const std::string& key) const { return table_.contains(key); }
  int line() const;
  int line_of(const std::string& key) const;

  /// Each returns nothing where the key is left out, and throws SceneError for another type or value. Whole numbers
  /// are accepted where a number is wanted; NaN and infinity are not.
  std::optional<double> number(const std::string& key, Allowed allowed = Allowed::any);
  std::optional<std::int64_t> integer(const std::string& key, std::int64_t least, std::int64_t most);
  std::optional<bool> boolean(const std::string& key);
  std::optional<std::string> text(const std::string& key);
  std::optional<std::array<double, 2>> number_pair(const std::string& key, Allowed allowed = Allowed::any);
  std::optional<std::array<std::int64_t, 2>> integer_pair(const std::string& key, std::int64_t least,
                                                          std::int64_t most);
  std::vector<double> numbers(const std::string& key, Allowed allowed = Allowed::any);
  std::vector<std::array<double, 2>> number_pairs(const std::string& key);
  std::vector<std::string> texts(const std::string& key, const std::vector<std::string>& choices);

  /// A text that must be one of `choices`.
  std::optional<std::string> choice(const std::string& key, const std::vector<std::string>& choices);

  /// A table inside this one, labelled "[key]" or "[lower.hardening]".
  std::optional<TomlTable> table(const std::string& key);

  /// The tables of [[key]].
  std::vector<TomlTable> tables(const std::string& key);

  /// The value; where it is left out, a default that `finish` will refuse.
  template <class Value>
  Value required(const std::string& key, std::optional<Value> value) {
    if (!value) missing_.push_back(key);
    return std::move(value).value_or(Value{});
  }

  /// "normal_force = -1.0, " and the text, with the line of the key.
  [[noreturn]] void fail_key(const std::string& key, const std::string& text) const;

  /// With the line of the table.
  [[noreturn]] void fail(const std::string& text) const;

  /// Call when all keys have been asked for: refuses unknown keys first, since a misspelt one is why another is
  /// missing, then missing ones.
  void finish() const;

 private:
  const toml::node* find(const std::string& key);
  double checked_number(const std::string& key, const toml::node& node, Allowed allowed) const;
  std::int64_t checked_integer(const std::string& key, const toml::node& node, std::int64_t least,
                               std::int64_t most) const;
  const toml::array& checked_array(const std::string& key, const toml::node& node, const std::string& wanted,
                                   std::size_t size) const;
  [[noreturn]] void fail_at(int line, const std::string& text) const;
  [[noreturn]] void fail_type(const std::string& key, const toml::node& node, const std::string& wanted) const;

  const toml::table& table_;
  std::string file_name_;
  std::string label_;
  std::set<std::string> known_;
  std::vector<std::string> missing_;
};

}  // namespace brinell::cli
