// Numbers of workgroups and threads where a dispatch has more workgroups than one row of it takes: then it has several rows
// of as many each (Commands::dispatch, grid.glsl), and more workgroups than there is work for. Workgroups have one dimension;
// their size stands before this is included.
#ifndef THREAD_GLSL
#define THREAD_GLSL

uint workgroup_number() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uint thread_number() { return workgroup_number() * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }

#endif
