// Bytes and errors of the four takes of the bench rig in ACL and in ozz-animation, by the measure that the compressed
// takes of this library are tested with: the largest distance, at any key, of three points on a shell around a bone, in
// model space.
//
// Output, separated by tabs: take, setting, codec, bytes, largest error in millimeters, seconds to compress.
#define main driver_main
#include "acl_bench.cc"
#undef main

template <class PoseAt> static Err error_at_keys(const Skeleton& s, const Clip& c, double shell, PoseAt pose_at) {
  Err e;
  for (int key = 0; key < c.frames; ++key) add_err(s, c.raw[key], pose_at(key / c.rate), shell, e);
  return e;
}

static Err acl_at_keys(const Skeleton& s, const Clip& c, const acl::compressed_tracks& t, double shell) {
  Ctx ctx;
  ctx.initialize(t);
  std::vector<rtm::qvvf> o(s.num_joints());
  Writer w(o.data());
  return error_at_keys(s, c, shell, [&](double time) {
    ctx.seek((float)std::min<double>(time, c.duration), acl::sample_rounding_policy::none);
    ctx.decompress_tracks(w);
    Pose p;
    for (auto& q : o) {
      float r[4], m[4], k[4];
      rtm::quat_store(q.rotation, r); rtm::vector_store(q.translation, m); rtm::vector_store(q.scale, k);
      p.push_back({{m[0], m[1], m[2]}, {r[0], r[1], r[2], r[3]}, {k[0], k[1], k[2]}});
    }
    return p;
  });
}

static Err ozz_at_keys(const Skeleton& s, const Clip& c, const Animation& a, double shell) {
  SamplingJob::Context ctx(s.num_joints());
  ozz::vector<ozz::math::SoaTransform> o(s.num_soa_joints());
  return error_at_keys(s, c, shell, [&](double time) {
    SamplingJob j;
    j.animation = &a; j.context = &ctx; j.ratio = (float)(time / c.duration); j.output = ozz::make_span(o);
    j.Run();
    Pose p;
    for (int i = 0; i < s.num_joints(); ++i) {
      const auto& q = o[i / 4];
      auto lane = [&](const ozz::math::SimdFloat4& v) { float b[4]; ozz::math::StorePtrU(v, b); return (double)b[i & 3]; };
      p.push_back({{lane(q.translation.x), lane(q.translation.y), lane(q.translation.z)},
                   {lane(q.rotation.x), lane(q.rotation.y), lane(q.rotation.z), lane(q.rotation.w)},
                   {lane(q.scale.x), lane(q.scale.y), lane(q.scale.z)}});
    }
    return p;
  });
}

int main(int argc, char** argv) {
  if (argc < 2) { fprintf(stderr, "usage: acl_sizes DATA\n"); return 1; }
  std::string d = argv[1];
  Skeleton s;
  load(d + "/pab_skeleton.ozz", &s);
  struct { const char* name; float precision, shell; } settings[] = {{"0.1 mm at 3 cm", 1e-4f, 3e-2f}, {"1 mm at 10 cm", 1e-3f, 1e-1f}};
  for (auto n : {"walk", "jog", "run", "atlas"}) {
    RawAnimation ra;
    load(d + "/pab_" + n + ".raw.ozz", &ra);
    Clip c = make_clip(n, ra, 1);
    for (auto& q : settings) {
      auto line = [&](const char* codec, size_t bytes, Err e, double seconds) {
        printf("%s\t%s\t%s\t%zu\t%.4f\t%.4f\n", n, q.name, codec, bytes, e.max * 1e3, seconds);
      };
      double seconds;
      auto* t = compress(s, c, q.precision, q.shell, acl::compression_level8::automatic, &seconds);
      line("ACL", t->get_size(), acl_at_keys(s, c, *t, q.shell), seconds);
      g_alloc.deallocate(t, t->get_size());
      double begin = now_ns();
      ozz::animation::offline::AnimationOptimizer optimizer;
      optimizer.setting = {q.precision, q.shell};
      RawAnimation reduced;
      optimizer(ra, s, &reduced);
      ozz::animation::offline::AnimationBuilder builder;
      builder.iframe_interval = 10.f;
      auto a = builder(reduced);
      line("ozz", a->size(), ozz_at_keys(s, c, *a, q.shell), (now_ns() - begin) * 1e-9);
    }
  }
  return 0;
}
