// Numbers workgroups and threads across the rows of a dispatch. A dispatch of more workgroups than fit in one row has
// several equal rows (Commands::dispatch, grid.glsl), so the last row may have workgroups without work. Workgroups have
// one dimension; their size is declared before this file is included.
#ifndef THREAD_GLSL
#define THREAD_GLSL

uint workgroup_number() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uint thread_number() { return workgroup_number() * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }

#endif
