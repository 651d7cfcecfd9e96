// brn_hardening as the engine's description of a law.
#pragma once

#include <brinell.h>

#include "plastic/hardening.h"

namespace brinell::capi {

/// Throws if law is none of BRN_HARDENING_SWIFT to BRN_HARDENING_TABLE. Parameters are checked by plastic::check().
plastic::Hardening to_hardening(const brn_hardening* user, const char* name);

}  // namespace brinell::capi
