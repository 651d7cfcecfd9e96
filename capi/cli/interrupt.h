// Ctrl-C and a request to terminate, as a question that the solver's progress callback asks.
#pragma once

namespace brinell::cli {

/// From now on the first SIGINT or SIGTERM is only noted; a second one ends the program.
void catch_interrupts();

/// Whether one has been noted.
bool interrupted();

}  // namespace brinell::cli
