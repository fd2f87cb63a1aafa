/* One signature for what Embree 3 and Embree 4 declare differently: the calls that trace rays, and what goes with a call.
 *
 * Embree 3 passes a context with flags and filter to each call; Embree 4 passes arguments that point to a context. Both hand
 * the context's address to callbacks, so a caller's own data lies behind it, in EmbreeQuery. */

#ifndef EMBREE_SYS_SHIM_H
#define EMBREE_SYS_SHIM_H

#include <rtcore.h>

#include <stdbool.h>

enum EmbreeConstant
{
  /* No geometry, or no instance. */
  EMBREE_INVALID_ID = RTC_INVALID_GEOMETRY_ID,
#if RTC_VERSION_MAJOR >= 4
  /* Scene flag: the filter of a query is called. */
  EMBREE_SCENE_FLAG_QUERY_FILTER = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS,
  /* Whether there are stream calls. */
  EMBREE_HAS_STREAMS = 0,
#else
  EMBREE_SCENE_FLAG_QUERY_FILTER = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION,
  EMBREE_HAS_STREAMS = 1,
#endif
};

#if RTC_VERSION_MAJOR >= 4
typedef struct RTCRayQueryContext EmbreeContext;
#else
typedef struct RTCIntersectContext EmbreeContext;
#endif

/* What one call to trace rays carries; one thread uses it at a time. Fill it by embree_query_init alone. */
typedef struct EmbreeQuery
{
  EmbreeContext context; /* First: callbacks get its address, and find the query by it. */
  void* user;
  RTCFilterFunctionN filter;
  bool coherent;
} EmbreeQuery;

/* `coherent` is a promise about the rays that only speed depends on. `filter` may be NULL; it is called for every hit, in scenes
 * with EMBREE_SCENE_FLAG_QUERY_FILTER. `user` is for callbacks, by embree_context_user. */
void embree_query_init(EmbreeQuery* query, bool coherent, RTCFilterFunctionN filter, void* user);

/* The `user` of the query that a callback's context belongs to. */
void* embree_context_user(const EmbreeContext* context);

/* The instance that a callback is inside of, outermost first; EMBREE_INVALID_ID without one. */
unsigned int embree_context_instance(const EmbreeContext* context, unsigned int level);

/* Closest hits. A lane with valid == 0 is left alone, one with -1 is traced. */
void embree_intersect1(RTCScene scene, EmbreeQuery* query, struct RTCRayHit* rayhit);
void embree_intersect4(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRayHit4* rayhit);
void embree_intersect8(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRayHit8* rayhit);
void embree_intersect16(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRayHit16* rayhit);

/* Any hit: an occluded ray's tfar becomes minus infinity. */
void embree_occluded1(RTCScene scene, EmbreeQuery* query, struct RTCRay* ray);
void embree_occluded4(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRay4* ray);
void embree_occluded8(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRay8* ray);
void embree_occluded16(const int* valid, RTCScene scene, EmbreeQuery* query, struct RTCRay16* ray);

/* Streams of `count` rays; a ray with tnear > tfar is left alone. Where EMBREE_HAS_STREAMS is 0 they trace nothing and return
 * false. */
bool embree_intersect1_stream(RTCScene scene, EmbreeQuery* query, struct RTCRayHit* rayhits, unsigned int count);
bool embree_occluded1_stream(RTCScene scene, EmbreeQuery* query, struct RTCRay* rays, unsigned int count);
/* `count` packets of 8, one behind the other. */
bool embree_intersect8_stream(RTCScene scene, EmbreeQuery* query, struct RTCRayHit8* packets, unsigned int count);
bool embree_occluded8_stream(RTCScene scene, EmbreeQuery* query, struct RTCRay8* packets, unsigned int count);

/* In an intersect callback of a user geometry: lane `lane` of the packet is hit at distance `t`, which becomes the ray's tfar.
 * Of the hit it writes the ids: primitive, geometry, and the instances of `args->context`. */
void embree_accept_hit(const struct RTCIntersectFunctionNArguments* args, unsigned int lane, float t);

#endif
