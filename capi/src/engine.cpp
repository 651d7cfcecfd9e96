#include <brinell.h>

#include <cstring>

#include "handles.h"
#include "simd/kernel_table.h"
#include "structs.h"

using namespace brinell;
using namespace brinell::capi;

extern "C" {

brn_status brn_engine_create(const brn_engine_options* options, brn_engine** out) {
  if (out != nullptr) *out = nullptr;
  return guarded(nullptr, [&] {
    require(out, "out");
    scene::EngineOptions wanted;
    if (options != nullptr) {
      const auto given =
          read(options, "options", brn_engine_options_init, &brn_engine_options::threads, &brn_engine_options::isa,
               &brn_engine_options::wisdom, &brn_engine_options::memory_limit, &brn_engine_options::cache_limit);
      wanted.threads = given.threads;
      wanted.isa = given.isa;
      if (given.wisdom != nullptr) wanted.wisdom = given.wisdom;
      wanted.memory_limit = given.memory_limit;
      wanted.cache_limit = given.cache_limit;
    }
    *out = new brn_engine(wanted);
  });
}

void brn_engine_destroy(brn_engine* engine) {
  delete engine;
}

const char* brn_engine_message(const brn_engine* engine) {
  return engine != nullptr ? engine->messages.get() : brn_last_message();
}

int32_t brn_engine_isa(const brn_engine* engine) {
  return engine != nullptr ? static_cast<int32_t>(engine->engine.kernels().isa) : 0;
}

const char* brn_engine_isa_name(const brn_engine* engine) {
  return engine != nullptr ? simd::name(engine->engine.kernels().isa).data() : "";
}

int32_t brn_engine_threads(const brn_engine* engine) {
  return engine != nullptr ? engine->engine.arena().threads() : 0;
}

brn_status brn_engine_export_wisdom(brn_engine* engine, char* buffer, size_t capacity, size_t* size) {
  return guarded(engine != nullptr ? &engine->messages : nullptr, [&] {
    require(engine, "engine");
    require(size, "size");
    const std::string wisdom = engine->engine.export_wisdom();
    *size = wisdom.size() + 1;
    if (capacity == 0) return;
    require(buffer, "buffer");
    if (capacity < *size) {
      fail(Status::short_buffer,
           "buffer holds " + std::to_string(capacity) + " bytes; needed are " + std::to_string(*size));
    }
    std::memcpy(buffer, wisdom.c_str(), *size);
  });
}
}
