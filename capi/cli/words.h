// What a message about a wrong word says: the word that was probably meant, and those that are allowed.
#pragma once

#include <string>
#include <vector>

namespace brinell::cli {

/// The candidate that has the word in it, or the fewest typing errors between them; candidates must not be empty.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

}  // namespace brinell::cli
