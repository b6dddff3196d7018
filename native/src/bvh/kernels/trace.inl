// SPDX-License-Identifier: GPL-3.0-or-later
// What a kernel does with the rays of one call: of few each walks alone; of many those that go together walk in packets, the others in the
// stream.

struct Scratch {
  StreamScratch stream;
  PacketScratch packet;
};

// Whether neighbours point much the same way. Where they start shows while they walk.
inline bool go_together(const char* rays) {
  const auto direction = [&](unsigned ray) {
    return Float4::load_anywhere(
        reinterpret_cast<const float*>(rays + sizeof(KernelRay) * ray + offsetof(KernelRay, direction)));
  };
  Float4 least = direction(0), most = least;
  for (unsigned ray = 1; ray < packet_size; ++ray) {
    least = min(direction(ray), least);
    most = max(direction(ray), most);
  }
  const unsigned is_same_side = ~(least.sign_bits() ^ most.sign_bits());
  alignas(16) float size[4], spread[4];
  max(abs(least), abs(most)).store(size);
  (most - least).store(spread);
  const float largest =
      size[0] > size[1] ? (size[0] > size[2] ? size[0] : size[2]) : (size[1] > size[2] ? size[1] : size[2]);
  return (is_same_side & 7) == 7 && spread[0] + spread[1] + spread[2] < 0.25f * largest;
}

// For fewer the stream is slower: its turns would be mostly empty.
constexpr std::size_t smallest_stream = 6;

template <class Query>
void trace_each_alone(const Steps<Query>& steps, std::size_t count, StreamScratch& scratch) {
  Slot& slot = scratch.slots[0];
  slot.stack = &scratch.stacks[0];
  for (std::size_t i = 0; i < count; ++i) walk_alone(steps, i, slot);
}

template <class Query>
void trace(const KernelScene& scene, const char* rays, std::size_t count, Query query, Scratch& scratch) {
  const Steps<Query> steps{scene, rays, query};
  if (count < smallest_stream) return trace_each_alone(steps, count, scratch.stream);
  // Where most packets are given up, the rest of the call's rays are not tried.
  unsigned packet_count = 0, given_up_count = 0;
  constexpr std::size_t chunk_size = 4096;
  std::uint32_t alone[chunk_size];
  for (std::size_t first = 0; first < count; first += chunk_size) {
    const std::size_t end = count - first < chunk_size ? count : first + chunk_size;
    std::size_t alone_count = 0;
    for (std::size_t i = first; i < end; i += packet_size) {
      const std::size_t size = end - i < packet_size ? end - i : packet_size;
      const char* packet_rays = rays + sizeof(KernelRay) * i;
      if (size == packet_size && scene.root != no_reference && given_up_count <= 2 + packet_count / 2 &&
          go_together(packet_rays)) {
        ++packet_count;
        PacketWalk walk(scene, scratch.packet, packet_rays, Query::ends_at_hit);
        if (walk.run()) {
          walk.store();
          const unsigned doubtful = Query::ends_at_hit ? 0 : walk.doubtful_rays();
          for (unsigned lane = 0; lane < packet_size; ++lane) query.write(scene, i + lane, walk.hit(lane));
          for (unsigned rest = doubtful; rest != 0; rest &= rest - 1)
            alone[alone_count++] = static_cast<std::uint32_t>(i + static_cast<unsigned>(__builtin_ctz(rest)));
          continue;
        }
        ++given_up_count;
      }
      for (std::size_t j = 0; j < size; ++j) alone[alone_count++] = static_cast<std::uint32_t>(i + j);
    }
    Stream(steps, alone, alone_count, scratch.stream).run();
  }
}

inline void intersect(const KernelScene& scene, const void* rays, void* hits, std::size_t count, void* scratch) {
  trace(scene, static_cast<const char*>(rays), count, NearestQuery{static_cast<char*>(hits)},
        *static_cast<Scratch*>(scratch));
}
inline void occluded(const KernelScene& scene, const void* rays, std::uint8_t* results, std::size_t count,
                     void* scratch) {
  trace(scene, static_cast<const char*>(rays), count, AnyQuery{results}, *static_cast<Scratch*>(scratch));
}
