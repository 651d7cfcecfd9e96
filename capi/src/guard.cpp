#include "guard.h"

namespace brinell::capi {

static_assert(static_cast<brn_status>(Status::ok) == BRN_OK);
static_assert(static_cast<brn_status>(Status::invalid_argument) == BRN_INVALID_ARGUMENT);
static_assert(static_cast<brn_status>(Status::invalid_scene) == BRN_INVALID_SCENE);
static_assert(static_cast<brn_status>(Status::wrong_state) == BRN_WRONG_STATE);
static_assert(static_cast<brn_status>(Status::short_buffer) == BRN_SHORT_BUFFER);
static_assert(static_cast<brn_status>(Status::unsupported) == BRN_UNSUPPORTED);
static_assert(static_cast<brn_status>(Status::out_of_memory) == BRN_OUT_OF_MEMORY);
static_assert(static_cast<brn_status>(Status::too_large) == BRN_TOO_LARGE);
static_assert(static_cast<brn_status>(Status::not_converged) == BRN_NOT_CONVERGED);
static_assert(static_cast<brn_status>(Status::no_equilibrium) == BRN_NO_EQUILIBRIUM);
static_assert(static_cast<brn_status>(Status::cancelled) == BRN_CANCELLED);
static_assert(static_cast<brn_status>(Status::damaged_data) == BRN_DAMAGED_DATA);
static_assert(static_cast<brn_status>(Status::internal) == BRN_INTERNAL);

std::string& last_message() {
  thread_local std::string message;
  return message;
}

void keep(Messages* messages, const char* message) noexcept {
  try {
    if (messages != nullptr) messages->set(message);
    last_message() = message;
  } catch (...) {  // no memory for a message: the status alone has to do
    return;
  }
}

void require(const void* pointer, const char* name) {
  if (pointer == nullptr) fail(Status::invalid_argument, std::string(name) + " is NULL");
}

}  // namespace brinell::capi

extern "C" {

const char* brn_last_message(void) {
  return brinell::capi::last_message().c_str();
}

const char* brn_status_name(brn_status status) {
  switch (status) {
    case BRN_OK: return "BRN_OK";
    case BRN_INVALID_ARGUMENT: return "BRN_INVALID_ARGUMENT";
    case BRN_INVALID_SCENE: return "BRN_INVALID_SCENE";
    case BRN_WRONG_STATE: return "BRN_WRONG_STATE";
    case BRN_SHORT_BUFFER: return "BRN_SHORT_BUFFER";
    case BRN_UNSUPPORTED: return "BRN_UNSUPPORTED";
    case BRN_OUT_OF_MEMORY: return "BRN_OUT_OF_MEMORY";
    case BRN_TOO_LARGE: return "BRN_TOO_LARGE";
    case BRN_NOT_CONVERGED: return "BRN_NOT_CONVERGED";
    case BRN_NO_EQUILIBRIUM: return "BRN_NO_EQUILIBRIUM";
    case BRN_CANCELLED: return "BRN_CANCELLED";
    case BRN_DAMAGED_DATA: return "BRN_DAMAGED_DATA";
    case BRN_INTERNAL: return "BRN_INTERNAL";
    default: return "unknown status";
  }
}

const char* brn_version(void) {
  return BRINELL_VERSION;
}
}
