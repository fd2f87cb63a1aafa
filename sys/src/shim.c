#include "shim.h"

#include <stddef.h>

void embree_query_init(EmbreeQuery* query, bool coherent, RTCFilterFunctionN filter, void* user)
{
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&query->context);
#else
  rtcInitIntersectContext(&query->context);
  query->context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  query->context.filter = filter;
#endif
  query->user = user;
  query->filter = filter;
  query->coherent = coherent;
}

void* embree_context_user(const EmbreeContext* context)
{
  return ((const EmbreeQuery*)context)->user;
}

unsigned int embree_context_instance(const EmbreeContext* context, unsigned int level)
{
  return level < RTC_MAX_INSTANCE_LEVEL_COUNT ? context->instID[level] : RTC_INVALID_GEOMETRY_ID;
}

#if RTC_VERSION_MAJOR >= 4

static enum RTCRayQueryFlags query_flags(const EmbreeQuery* query)
{
  enum RTCRayQueryFlags flags = query->coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return query->filter ? flags | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : flags;
}

static struct RTCIntersectArguments intersect_arguments(EmbreeQuery* query)
{
  struct RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = query_flags(query);
  arguments.context = &query->context;
  arguments.filter = query->filter;
  return arguments;
}

static struct RTCOccludedArguments occluded_arguments(EmbreeQuery* query)
{
  struct RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = query_flags(query);
  arguments.context = &query->context;
  arguments.filter = query->filter;
  return arguments;
}

void embree_intersect1(RTCScene scene, EmbreeQuery* query, struct RTCRayHit* rayhit)
{
  struct RTCIntersectArguments arguments = intersect_arguments(query);
  rtcIntersect1(scene, rayhit, &arguments);
}

void embree_occluded1(RTCScene scene, EmbreeQuery* query, struct RTCRay* ray)
{
  struct RTCOccludedArguments arguments = occluded_arguments(query);
  rtcOccluded1(scene, ray, &arguments);
}

#define PACKET_CALLS(N)                                                                                           \
  void embree_intersect##N(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRayHit##N* rayhit)    \
  {                                                                                                               \
    struct RTCIntersectArguments arguments = intersect_arguments(query);                                          \
    rtcIntersect##N(valid, scene, rayhit, &arguments);                                                            \
  }                                                                                                               \
  void embree_occluded##N(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRay##N* ray)           \
  {                                                                                                               \
    struct RTCOccludedArguments arguments = occluded_arguments(query);                                            \
    rtcOccluded##N(valid, scene, ray, &arguments);                                                                \
  }

bool embree_intersect1_stream(RTCScene scene, EmbreeQuery* query, struct RTCRayHit* rayhits, unsigned int count)
{
  (void)scene, (void)query, (void)rayhits, (void)count;
  return false;
}

bool embree_occluded1_stream(RTCScene scene, EmbreeQuery* query, struct RTCRay* rays, unsigned int count)
{
  (void)scene, (void)query, (void)rays, (void)count;
  return false;
}

bool embree_intersect8_stream(RTCScene scene, EmbreeQuery* query, struct RTCRayHit8* packets, unsigned int count)
{
  (void)scene, (void)query, (void)packets, (void)count;
  return false;
}

bool embree_occluded8_stream(RTCScene scene, EmbreeQuery* query, struct RTCRay8* packets, unsigned int count)
{
  (void)scene, (void)query, (void)packets, (void)count;
  return false;
}

#else

void embree_intersect1(RTCScene scene, EmbreeQuery* query, struct RTCRayHit* rayhit)
{
  rtcIntersect1(scene, &query->context, rayhit);
}

void embree_occluded1(RTCScene scene, EmbreeQuery* query, struct RTCRay* ray)
{
  rtcOccluded1(scene, &query->context, ray);
}

#define PACKET_CALLS(N)                                                                                           \
  void embree_intersect##N(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRayHit##N* rayhit)    \
  {                                                                                                               \
    rtcIntersect##N(valid, scene, &query->context, rayhit);                                                       \
  }                                                                                                               \
  void embree_occluded##N(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRay##N* ray)           \
  {                                                                                                               \
    rtcOccluded##N(valid, scene, &query->context, ray);                                                           \
  }

bool embree_intersect1_stream(RTCScene scene, EmbreeQuery* query, struct RTCRayHit* rayhits, unsigned int count)
{
  rtcIntersect1M(scene, &query->context, rayhits, count, sizeof(struct RTCRayHit));
  return true;
}

bool embree_occluded1_stream(RTCScene scene, EmbreeQuery* query, struct RTCRay* rays, unsigned int count)
{
  rtcOccluded1M(scene, &query->context, rays, count, sizeof(struct RTCRay));
  return true;
}

bool embree_intersect8_stream(RTCScene scene, EmbreeQuery* query, struct RTCRayHit8* packets, unsigned int count)
{
  rtcIntersectNM(scene, &query->context, (struct RTCRayHitN*)packets, 8, count, sizeof(struct RTCRayHit8));
  return true;
}

bool embree_occluded8_stream(RTCScene scene, EmbreeQuery* query, struct RTCRay8* packets, unsigned int count)
{
  rtcOccludedNM(scene, &query->context, (struct RTCRayN*)packets, 8, count, sizeof(struct RTCRay8));
  return true;
}

#endif

PACKET_CALLS(4)
PACKET_CALLS(8)
PACKET_CALLS(16)

/* A packet of N is N floats for each field, in the order of the declaration; the accessors in Embree's headers are C++. */
void embree_accept_hit(const struct RTCIntersectFunctionNArguments* args, unsigned int lane, float t)
{
  const unsigned int N = args->N;
  float* ray = (float*)args->rayhit;
  unsigned int* hit = (unsigned int*)(ray + 12 * N);
  ray[8 * N + lane] = t;
  hit[5 * N + lane] = args->primID;
  hit[6 * N + lane] = args->geomID;
  for (unsigned int level = 0; level < RTC_MAX_INSTANCE_LEVEL_COUNT; ++level)
  {
    hit[(7 + level) * N + lane] = args->context->instID[level];
#if RTC_VERSION_MAJOR >= 4 && defined(RTC_GEOMETRY_INSTANCE_ARRAY)
    hit[(7 + RTC_MAX_INSTANCE_LEVEL_COUNT + level) * N + lane] = args->context->instPrimID[level];
#endif
  }
}
