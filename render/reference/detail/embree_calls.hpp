#pragma once

// The few calls of Embree whose form changed between versions 3 and 4.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cstddef>
#include <glm/vec3.hpp>

namespace sunfleck::detail {

// A ray that `reach` [m] ends.
inline void set(RTCRay& ray, const glm::vec3& from, const glm::vec3& direction, float reach) {
  ray.org_x = from.x;
  ray.org_y = from.y;
  ray.org_z = from.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = 0.f;
  ray.tfar = reach;
  ray.time = 0.f;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
}

inline void set(RTCRay16& rays, std::size_t i, const glm::vec3& from, const glm::vec3& direction, float reach) {
  rays.org_x[i] = from.x;
  rays.org_y[i] = from.y;
  rays.org_z[i] = from.z;
  rays.dir_x[i] = direction.x;
  rays.dir_y[i] = direction.y;
  rays.dir_z[i] = direction.z;
  rays.tnear[i] = 0.f;
  rays.tfar[i] = reach;
  rays.time[i] = 0.f;
  rays.mask[i] = ~0u;
  rays.id[i] = 0;
  rays.flags[i] = 0;
}

enum class Coherence { incoherent, coherent };

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kFilterPerCall = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

inline RTCIntersectArguments intersectArguments(Coherence coherence) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  if (coherence == Coherence::coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  return arguments;
}
inline void closestHit(RTCScene scene, RTCRayHit& ray, Coherence coherence) {
  RTCIntersectArguments arguments = intersectArguments(coherence);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void anyHit(RTCScene scene, RTCRay& ray) {
  rtcOccluded1(scene, &ray);
}
inline void closestHits(const int* valid, RTCScene scene, RTCRayHit16& rays) {
  RTCIntersectArguments arguments = intersectArguments(Coherence::coherent);
  rtcIntersect16(valid, scene, &rays, &arguments);
}
inline void anyHits(const int* valid, RTCScene scene, RTCRay16& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &rays, &arguments);
}
inline void initialise(EmbreeContext& context) {
  rtcInitRayQueryContext(&context);
}
inline void filterHits(RTCScene scene, RTCRayHit& ray, EmbreeContext& context, RTCFilterFunctionN filter) {
  RTCIntersectArguments arguments = intersectArguments(Coherence::incoherent);
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  arguments.context = &context;
  arguments.filter = filter;
  rtcIntersect1(scene, &ray, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
inline constexpr RTCSceneFlags kFilterPerCall = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void initialise(EmbreeContext& context) {
  rtcInitIntersectContext(&context);
}
inline void closestHit(RTCScene scene, RTCRayHit& ray, Coherence coherence) {
  EmbreeContext context;
  initialise(context);
  if (coherence == Coherence::coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect1(scene, &context, &ray);
}
inline void anyHit(RTCScene scene, RTCRay& ray) {
  EmbreeContext context;
  initialise(context);
  rtcOccluded1(scene, &context, &ray);
}
inline void closestHits(const int* valid, RTCScene scene, RTCRayHit16& rays) {
  EmbreeContext context;
  initialise(context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &rays);
}
inline void anyHits(const int* valid, RTCScene scene, RTCRay16& rays) {
  EmbreeContext context;
  initialise(context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, &rays);
}
inline void filterHits(RTCScene scene, RTCRayHit& ray, EmbreeContext& context, RTCFilterFunctionN filter) {
  context.filter = filter;
  rtcIntersect1(scene, &context, &ray);
}
#endif

}  // namespace sunfleck::detail
