classdef remApi < handle
  % The legacy remote API of V-REP and CoppeliaSim, for GNU Octave and MATLAB, without a library: existing programs run as they are.
  %
  %     vrep = remApi('remoteApi');
  %     id = vrep.simxStart('127.0.0.1', 19997, true, true, 5000, 5);
  %     [code, joint] = vrep.simxGetObjectHandle(id, 'shoulder#', vrep.simx_opmode_blocking);
  %
  % Octave needs its package instrument-control (`pkg load instrument-control`), MATLAB nothing. Every call is one exchange with the
  % server, so there is no cycle to wait for, and a value that is streamed is there at once; return codes are those of the API:
  % 0 good, 1 no value yet, 8 refused by the server, 64 not connected. Units: m, rad, s, N, N m; quaternions x, y, z, w.

  properties (Constant)
    simx_return_ok = 0;
    simx_return_novalue_flag = 1;
    simx_return_timeout_flag = 2;
    simx_return_illegal_opmode_flag = 4;
    simx_return_remote_error_flag = 8;
    simx_return_local_error_flag = 32;
    simx_return_initialize_error_flag = 64;
    simx_opmode_oneshot = 0;
    simx_opmode_blocking = 65536;
    simx_opmode_oneshot_wait = 65536;
    simx_opmode_streaming = 131072;
    simx_opmode_continuous = 131072;
    simx_opmode_discontinue = 327680;
    simx_opmode_buffer = 393216;
    simx_opmode_remove = 458752;
    sim_handle_world = -1;
    sim_handle_parent = -11;
    sim_object_shape_type = 0;
    sim_object_joint_type = 1;
    sim_object_dummy_type = 4;
    sim_object_proximitysensor_type = 5;
    sim_object_visionsensor_type = 9;
    sim_object_forcesensor_type = 12;
    sim_handle_all = -2;
    sim_scripttype_mainscript = 0;
    sim_scripttype_childscript = 1;
    sim_scripttype_customizationscript = 6;
    sim_jointintparam_motor_enabled = 2000;
    sim_jointintparam_ctrl_enabled = 2001;
    sim_jointfloatparam_velocity = 2012;
    sim_shapefloatparam_mass = 3005;
    sim_floatparam_simulation_time_step = 1;
    sim_intparam_program_version = 1;
    sim_boolparam_realtime_simulation = 25;
    sim_arrayparam_gravity = 0;
    % the rest of V-REP's table
    sim_object_graph_type = 2;
    sim_object_camera_type = 3;
    sim_object_path_type = 8;
    sim_object_mill_type = 11;
    sim_object_light_type = 13;
    sim_object_mirror_type = 14;
    sim_object_octree_type = 15;
    sim_object_pointcloud_type = 16;
    sim_appobj_object_type = 109;
    sim_appobj_collision_type = 110;
    sim_appobj_distance_type = 111;
    sim_appobj_simulation_type = 112;
    sim_appobj_ik_type = 113;
    sim_appobj_constraintsolver_type = 114;
    sim_appobj_collection_type = 115;
    sim_appobj_ui_type = 116;
    sim_appobj_script_type = 117;
    sim_appobj_pathplanning_type = 118;
    sim_appobj_texture_type = 120;
    sim_appobj_motionplanning_type = 121;
    sim_ik_pseudo_inverse_method = 0;
    sim_ik_damped_least_squares_method = 1;
    sim_ik_jacobian_transpose_method = 2;
    sim_ik_x_constraint = 1;
    sim_ik_y_constraint = 2;
    sim_ik_z_constraint = 4;
    sim_ik_alpha_beta_constraint = 8;
    sim_ik_gamma_constraint = 16;
    sim_ik_avoidance_constraint = 64;
    sim_ikresult_not_performed = 0;
    sim_ikresult_success = 1;
    sim_ikresult_fail = 2;
    sim_light_omnidirectional_subtype = 1;
    sim_light_spot_subtype = 2;
    sim_light_directional_subtype = 3;
    sim_joint_revolute_subtype = 10;
    sim_joint_prismatic_subtype = 11;
    sim_joint_spherical_subtype = 12;
    sim_proximitysensor_pyramid_subtype = 30;
    sim_proximitysensor_cylinder_subtype = 31;
    sim_proximitysensor_disc_subtype = 32;
    sim_proximitysensor_cone_subtype = 33;
    sim_proximitysensor_ray_subtype = 34;
    sim_object_no_subtype = 200;
    sim_objectspecialproperty_collidable = 1;
    sim_objectspecialproperty_measurable = 2;
    sim_objectspecialproperty_detectable_ultrasonic = 16;
    sim_objectspecialproperty_detectable_infrared = 32;
    sim_objectspecialproperty_detectable_laser = 64;
    sim_objectspecialproperty_detectable_inductive = 128;
    sim_objectspecialproperty_detectable_capacitive = 256;
    sim_objectspecialproperty_renderable = 512;
    sim_objectspecialproperty_detectable_all = 496;
    sim_objectspecialproperty_cuttable = 1024;
    sim_objectspecialproperty_pathplanning_ignored = 2048;
    sim_modelproperty_not_collidable = 1;
    sim_modelproperty_not_measurable = 2;
    sim_modelproperty_not_renderable = 4;
    sim_modelproperty_not_detectable = 8;
    sim_modelproperty_not_cuttable = 16;
    sim_modelproperty_not_dynamic = 32;
    sim_modelproperty_not_respondable = 64;
    sim_modelproperty_not_reset = 128;
    sim_modelproperty_not_visible = 256;
    sim_modelproperty_scripts_inactive = 512;
    sim_modelproperty_not_showasinsidemodel = 1024;
    sim_modelproperty_not_model = 61440;
    sim_message_ui_button_state_change = 0;
    sim_message_object_selection_changed = 2;
    sim_message_model_loaded = 4;
    sim_message_keypress = 6;
    sim_message_bannerclicked = 7;
    sim_message_scene_loaded = 8;
    sim_message_prox_sensor_select_down = 9;
    sim_message_prox_sensor_select_up = 10;
    sim_message_pick_select_down = 11;
    sim_message_eventcallback_scenesave = 260;
    sim_message_eventcallback_modelsave = 261;
    sim_message_eventcallback_moduleopen = 262;
    sim_message_eventcallback_modulehandle = 263;
    sim_message_eventcallback_moduleclose = 264;
    sim_message_eventcallback_instancepass = 269;
    sim_message_eventcallback_broadcast = 270;
    sim_message_eventcallback_imagefilter_enumreset = 271;
    sim_message_eventcallback_imagefilter_enumerate = 272;
    sim_message_eventcallback_imagefilter_adjustparams = 273;
    sim_message_eventcallback_imagefilter_process = 275;
    sim_message_eventcallback_abouttoundo = 280;
    sim_message_eventcallback_undoperformed = 281;
    sim_message_eventcallback_abouttoredo = 282;
    sim_message_eventcallback_redoperformed = 283;
    sim_message_eventcallback_scripticondblclick = 284;
    sim_message_eventcallback_simulationabouttostart = 285;
    sim_message_eventcallback_simulationended = 286;
    sim_message_eventcallback_keypress = 288;
    sim_message_eventcallback_modulehandleinsensingpart = 289;
    sim_message_eventcallback_renderingpass = 290;
    sim_message_eventcallback_bannerclicked = 291;
    sim_message_eventcallback_menuitemselected = 292;
    sim_message_eventcallback_refreshdialogs = 293;
    sim_message_eventcallback_sceneloaded = 294;
    sim_message_eventcallback_modelloaded = 295;
    sim_message_eventcallback_instanceswitch = 296;
    sim_message_eventcallback_guipass = 297;
    sim_message_eventcallback_mainscriptabouttobecalled = 298;
    sim_message_eventcallback_rmlposition = 299;
    sim_message_eventcallback_rmlvelocity = 300;
    sim_message_eventcallback_pathplanningplugin = 303;
    sim_message_eventcallback_colladaplugin = 304;
    sim_message_eventcallback_opengl = 305;
    sim_message_eventcallback_openglframe = 306;
    sim_message_eventcallback_openglcameraview = 307;
    sim_message_eventcallback_proxsensorselectdown = 308;
    sim_message_eventcallback_proxsensorselectup = 309;
    sim_message_eventcallback_pickselectdown = 310;
    sim_message_eventcallback_rmlpos = 311;
    sim_message_eventcallback_rmlvel = 312;
    sim_message_eventcallback_rmlstep = 313;
    sim_message_eventcallback_rmlremove = 314;
    sim_message_eventcallback_rmlinfo = 315;
    sim_message_eventcallback_beforerendering = 316;
    sim_message_eventcallback_extrenderer_light = 318;
    sim_message_eventcallback_extrenderer_mesh = 319;
    sim_message_eventcallback_extrenderer_stop = 320;
    sim_message_eventcallback_extrenderer_triangles = 333;
    sim_message_eventcallback_simulationabouttoend = 334;
    sim_message_eventcallback_instanceabouttoswitch = 335;
    sim_message_simulation_start_resume_request = 4096;
    sim_message_simulation_pause_request = 4097;
    sim_message_simulation_stop_request = 4098;
    sim_displayattribute_renderpass = 1;
    sim_displayattribute_depthpass = 2;
    sim_displayattribute_pickpass = 4;
    sim_displayattribute_selected = 8;
    sim_displayattribute_groupselection = 16;
    sim_displayattribute_mainselection = 32;
    sim_displayattribute_forcewireframe = 64;
    sim_displayattribute_forbidwireframe = 128;
    sim_displayattribute_forbidedges = 256;
    sim_displayattribute_originalcolors = 512;
    sim_displayattribute_ignorelayer = 1024;
    sim_displayattribute_forvisionsensor = 2048;
    sim_displayattribute_colorcodedpickpass = 4096;
    sim_displayattribute_colorcoded = 8192;
    sim_displayattribute_trianglewireframe = 16384;
    sim_displayattribute_inertiaonly = 32768;
    sim_displayattribute_thickEdges = 65536;
    sim_displayattribute_dynamiccontentonly = 131072;
    sim_displayattribute_mirror = 262144;
    sim_displayattribute_useauxcomponent = 524288;
    sim_displayattribute_ignorerenderableflag = 1048576;
    sim_displayattribute_noopenglcallbacks = 2097152;
    sim_displayattribute_FREE = 4194304;
    sim_displayattribute_noghosts = 8388608;
    sim_displayattribute_nopointclouds = 16777216;
    sim_displayattribute_nodrawingobjects = 33554432;
    sim_displayattribute_noparticles = 67108864;
    sim_displayattribute_colorcodedtriangles = 134217728;
    sim_objectproperty_collapsed = 16;
    sim_objectproperty_selectable = 32;
    sim_objectproperty_selectmodelbaseinstead = 128;
    sim_objectproperty_dontshowasinsidemodel = 256;
    sim_objectproperty_canupdatedna = 1024;
    sim_objectproperty_selectinvisible = 2048;
    sim_objectproperty_depthinvisible = 4096;
    sim_objectproperty_cannotdelete = 8192;
    sim_objectproperty_cannotdeleteduringsim = 16384;
    sim_script_arg_null = 0;
    sim_script_arg_bool = 1;
    sim_script_arg_int32 = 2;
    sim_script_arg_float = 3;
    sim_script_arg_string = 4;
    sim_script_arg_invalid = 5;
    sim_script_arg_charbuff = 6;
    sim_script_arg_double = 7;
    sim_script_arg_table = 8;
    sim_buttonproperty_button = 0;
    sim_buttonproperty_label = 1;
    sim_buttonproperty_slider = 2;
    sim_buttonproperty_editbox = 3;
    sim_buttonproperty_staydown = 8;
    sim_buttonproperty_enabled = 16;
    sim_buttonproperty_borderless = 32;
    sim_buttonproperty_horizontallycentered = 64;
    sim_buttonproperty_ignoremouse = 128;
    sim_buttonproperty_isdown = 256;
    sim_buttonproperty_transparent = 512;
    sim_buttonproperty_nobackgroundcolor = 1024;
    sim_buttonproperty_rollupaction = 2048;
    sim_buttonproperty_closeaction = 4096;
    sim_buttonproperty_verticallycentered = 8192;
    sim_buttonproperty_downupevent = 16384;
    sim_simulation_stopped = 0;
    sim_simulation_paused = 8;
    sim_simulation_advancing = 16;
    sim_simulation_advancing_firstafterstop = 16;
    sim_simulation_advancing_running = 17;
    sim_simulation_advancing_lastbeforepause = 19;
    sim_simulation_advancing_firstafterpause = 20;
    sim_simulation_advancing_abouttostop = 21;
    sim_simulation_advancing_lastbeforestop = 22;
    sim_script_no_error = 0;
    sim_script_main_script_nonexistent = 1;
    sim_script_main_script_not_called = 2;
    sim_script_reentrance_error = 4;
    sim_script_lua_error = 8;
    sim_script_call_error = 16;
    sim_scripttype_addonscript = 2;
    sim_scripttype_addonfunction = 3;
    sim_scripttype_jointctrlcallback = 4;
    sim_scripttype_contactcallback = 5;
    sim_scripttype_generalcallback = 7;
    sim_scripttype_sandboxscript = 8;
    sim_scripttype_threaded = 240;
    sim_api_error_report = 1;
    sim_api_error_output = 2;
    sim_api_warning_output = 4;
    sim_api_errormessage_ignore = 0;
    sim_api_errormessage_report = 1;
    sim_api_errormessage_output = 2;
    sim_handle_all_except_explicit = -3;
    sim_handle_self = -4;
    sim_handle_main_script = -5;
    sim_handle_tree = -6;
    sim_handle_chain = -7;
    sim_handle_single = -8;
    sim_handle_default = -9;
    sim_handle_all_except_self = -10;
    sim_handle_scene = -12;
    sim_handle_app = -13;
    sim_dlgstyle_message = 0;
    sim_dlgstyle_input = 1;
    sim_dlgstyle_ok = 2;
    sim_dlgstyle_ok_cancel = 3;
    sim_dlgstyle_yes_no = 4;
    sim_dlgstyle_dont_center = 32;
    sim_dlgret_still_open = 0;
    sim_dlgret_ok = 1;
    sim_dlgret_cancel = 2;
    sim_dlgret_yes = 3;
    sim_dlgret_no = 4;
    sim_pathproperty_show_line = 1;
    sim_pathproperty_show_orientation = 2;
    sim_pathproperty_closed_path = 4;
    sim_pathproperty_automatic_orientation = 8;
    sim_pathproperty_invert_velocity_deprecated = 16;
    sim_pathproperty_infinite_acceleration_deprecated = 32;
    sim_pathproperty_flat_path = 64;
    sim_pathproperty_show_position = 128;
    sim_pathproperty_auto_velocity_profile_translation_deprecated = 256;
    sim_pathproperty_auto_velocity_profile_rotation_deprecated = 512;
    sim_pathproperty_endpoints_at_zero_deprecated = 1024;
    sim_pathproperty_keep_x_up = 2048;
    sim_drawing_points = 0;
    sim_drawing_lines = 1;
    sim_drawing_triangles = 2;
    sim_drawing_trianglepoints = 3;
    sim_drawing_quadpoints = 4;
    sim_drawing_discpoints = 5;
    sim_drawing_cubepoints = 6;
    sim_drawing_spherepoints = 7;
    sim_drawing_itemcolors = 32;
    sim_drawing_vertexcolors = 64;
    sim_drawing_itemsizes = 128;
    sim_drawing_backfaceculling = 256;
    sim_drawing_wireframe = 512;
    sim_drawing_painttag = 1024;
    sim_drawing_followparentvisibility = 2048;
    sim_drawing_cyclic = 4096;
    sim_drawing_50percenttransparency = 8192;
    sim_drawing_25percenttransparency = 16384;
    sim_drawing_12percenttransparency = 32768;
    sim_drawing_emissioncolor = 65536;
    sim_drawing_facingcamera = 131072;
    sim_drawing_overlay = 262144;
    sim_drawing_itemtransparency = 524288;
    sim_drawing_persistent = 1048576;
    sim_drawing_auxchannelcolor1 = 2097152;
    sim_drawing_auxchannelcolor2 = 4194304;
    sim_banner_left = 1;
    sim_banner_right = 2;
    sim_banner_nobackground = 4;
    sim_banner_overlay = 8;
    sim_banner_followparentvisibility = 16;
    sim_banner_clickselectsparent = 32;
    sim_banner_clicktriggersevent = 64;
    sim_banner_facingcamera = 128;
    sim_banner_fullyfacingcamera = 256;
    sim_banner_backfaceculling = 512;
    sim_banner_keepsamesize = 1024;
    sim_banner_bitmapfont = 2048;
    sim_particle_points1 = 0;
    sim_particle_points2 = 1;
    sim_particle_points4 = 2;
    sim_particle_roughspheres = 3;
    sim_particle_spheres = 4;
    sim_particle_respondable1to4 = 32;
    sim_particle_respondable5to8 = 64;
    sim_particle_particlerespondable = 128;
    sim_particle_ignoresgravity = 256;
    sim_particle_invisible = 512;
    sim_particle_itemsizes = 1024;
    sim_particle_itemdensities = 2048;
    sim_particle_itemcolors = 4096;
    sim_particle_cyclic = 8192;
    sim_particle_emissioncolor = 16384;
    sim_particle_water = 32768;
    sim_particle_painttag = 65536;
    sim_boolparam_hierarchy_visible = 0;
    sim_boolparam_console_visible = 1;
    sim_boolparam_collision_handling_enabled = 2;
    sim_boolparam_distance_handling_enabled = 3;
    sim_boolparam_ik_handling_enabled = 4;
    sim_boolparam_gcs_handling_enabled = 5;
    sim_boolparam_dynamics_handling_enabled = 6;
    sim_boolparam_joint_motion_handling_enabled_deprecated = 7;
    sim_boolparam_path_motion_handling_enabled_deprecated = 8;
    sim_boolparam_proximity_sensor_handling_enabled = 9;
    sim_boolparam_vision_sensor_handling_enabled = 10;
    sim_boolparam_mill_handling_enabled = 11;
    sim_boolparam_browser_visible = 12;
    sim_boolparam_scene_and_model_load_messages = 13;
    sim_boolparam_shape_textures_are_visible = 15;
    sim_boolparam_display_enabled = 16;
    sim_boolparam_infotext_visible = 17;
    sim_boolparam_statustext_open = 18;
    sim_boolparam_fog_enabled = 19;
    sim_boolparam_rml2_available = 20;
    sim_boolparam_rml4_available = 21;
    sim_boolparam_mirrors_enabled = 22;
    sim_boolparam_aux_clip_planes_enabled = 23;
    sim_boolparam_use_glfinish_cmd = 26;
    sim_boolparam_force_show_wireless_emission = 27;
    sim_boolparam_force_show_wireless_reception = 28;
    sim_boolparam_video_recording_triggered = 29;
    sim_boolparam_threaded_rendering_enabled = 32;
    sim_boolparam_fullscreen = 33;
    sim_boolparam_headless = 34;
    sim_boolparam_hierarchy_toolbarbutton_enabled = 35;
    sim_boolparam_browser_toolbarbutton_enabled = 36;
    sim_boolparam_objectshift_toolbarbutton_enabled = 37;
    sim_boolparam_objectrotate_toolbarbutton_enabled = 38;
    sim_boolparam_force_calcstruct_all_visible = 39;
    sim_boolparam_force_calcstruct_all = 40;
    sim_boolparam_exit_request = 41;
    sim_boolparam_play_toolbarbutton_enabled = 42;
    sim_boolparam_pause_toolbarbutton_enabled = 43;
    sim_boolparam_stop_toolbarbutton_enabled = 44;
    sim_boolparam_waiting_for_trigger = 45;
    sim_boolparam_objproperties_toolbarbutton_enabled = 46;
    sim_boolparam_calcmodules_toolbarbutton_enabled = 47;
    sim_boolparam_rosinterface_donotrunmainscript = 48;
    sim_boolparam_online_mode = 49;
    sim_boolparam_br_partrepository = 50;
    sim_boolparam_br_palletrepository = 51;
    sim_boolparam_scene_closing = 52;
    sim_boolparam_show_w_emitters = 53;
    sim_boolparam_show_w_receivers = 54;
    sim_boolparam_br_jobfunc = 55;
    sim_intparam_error_report_mode = 0;
    sim_intparam_instance_count = 2;
    sim_intparam_custom_cmd_start_id = 3;
    sim_intparam_compilation_version = 4;
    sim_intparam_current_page = 5;
    sim_intparam_flymode_camera_handle = 6;
    sim_intparam_dynamic_step_divider = 7;
    sim_intparam_dynamic_engine = 8;
    sim_intparam_server_port_range = 10;
    sim_intparam_visible_layers = 11;
    sim_intparam_infotext_style = 12;
    sim_intparam_settings = 13;
    sim_intparam_edit_mode_type = 14;
    sim_intparam_server_port_next = 15;
    sim_intparam_qt_version = 16;
    sim_intparam_event_flags_read = 17;
    sim_intparam_event_flags_read_clear = 18;
    sim_intparam_platform = 19;
    sim_intparam_scene_unique_id = 20;
    sim_intparam_work_thread_count = 21;
    sim_intparam_mouse_x = 22;
    sim_intparam_mouse_y = 23;
    sim_intparam_core_count = 24;
    sim_intparam_work_thread_calc_time_ms = 25;
    sim_intparam_idle_fps = 26;
    sim_intparam_prox_sensor_select_down = 27;
    sim_intparam_prox_sensor_select_up = 28;
    sim_intparam_stop_request_counter = 29;
    sim_intparam_program_revision = 30;
    sim_intparam_mouse_buttons = 31;
    sim_intparam_dynamic_warning_disabled_mask = 32;
    sim_intparam_simulation_warning_disabled_mask = 33;
    sim_intparam_scene_index = 34;
    sim_intparam_motionplanning_seed = 35;
    sim_intparam_speedmodifier = 36;
    sim_intparam_dynamic_iteration_count = 37;
    sim_floatparam_rand = 0;
    sim_floatparam_stereo_distance = 2;
    sim_floatparam_dynamic_step_size = 3;
    sim_floatparam_mouse_wheel_zoom_factor = 4;
    sim_stringparam_application_path = 0;
    sim_stringparam_video_filename = 1;
    sim_stringparam_app_arg1 = 2;
    sim_stringparam_app_arg2 = 3;
    sim_stringparam_app_arg3 = 4;
    sim_stringparam_app_arg4 = 5;
    sim_stringparam_app_arg5 = 6;
    sim_stringparam_app_arg6 = 7;
    sim_stringparam_app_arg7 = 8;
    sim_stringparam_app_arg8 = 9;
    sim_stringparam_app_arg9 = 10;
    sim_stringparam_additional_addonscript_firstscene = 11;
    sim_stringparam_additional_addonscript = 12;
    sim_stringparam_scene_path_and_name = 13;
    sim_stringparam_scene_path = 14;
    sim_stringparam_scene_name = 15;
    sim_stringparam_remoteapi_temp_file_dir = 16;
    sim_stringparam_job = 17;
    sim_stringparam_job0 = 18;
    sim_stringparam_job99 = 117;
    sim_stringparam_scene_unique_id = 118;
    sim_arrayparam_fog = 1;
    sim_arrayparam_fog_color = 2;
    sim_arrayparam_background_color1 = 3;
    sim_arrayparam_background_color2 = 4;
    sim_arrayparam_ambient_light = 5;
    sim_arrayparam_random_euler = 6;
    sim_jointmode_passive = 0;
    sim_jointmode_motion_deprecated = 1;
    sim_jointmode_ik = 2;
    sim_jointmode_dependent = 4;
    sim_jointmode_force = 5;
    sim_navigation_passive = 0;
    sim_navigation_camerashift = 1;
    sim_navigation_camerarotate = 2;
    sim_navigation_camerazoom = 3;
    sim_navigation_cameratilt = 4;
    sim_navigation_cameraangle = 5;
    sim_navigation_camerafly = 6;
    sim_navigation_objectshift = 7;
    sim_navigation_objectrotate = 8;
    sim_navigation_createpathpoint = 256;
    sim_navigation_clickselection = 512;
    sim_navigation_ctrlselection = 1024;
    sim_navigation_shiftselection = 2048;
    sim_navigation_camerazoomwheel = 4096;
    sim_navigation_camerarotaterightbutton = 8192;
    sim_navigation_camerarotatemiddlebutton = 8192;
    sim_physics_bullet = 0;
    sim_physics_ode = 1;
    sim_physics_vortex = 2;
    sim_physics_newton = 3;
    sim_pure_primitive_none = 0;
    sim_pure_primitive_plane = 1;
    sim_pure_primitive_disc = 2;
    sim_pure_primitive_cuboid = 3;
    sim_pure_primitive_spheroid = 4;
    sim_pure_primitive_cylinder = 5;
    sim_pure_primitive_cone = 6;
    sim_pure_primitive_heightfield = 7;
    sim_dummy_linktype_dynamics_loop_closure = 0;
    sim_dummy_linktype_dynamics_force_constraint = 1;
    sim_dummy_linktype_gcs_loop_closure = 2;
    sim_dummy_linktype_gcs_tip = 3;
    sim_dummy_linktype_gcs_target = 4;
    sim_dummy_linktype_ik_tip_target = 5;
    sim_colorcomponent_ambient = 0;
    sim_colorcomponent_ambient_diffuse = 0;
    sim_colorcomponent_diffuse = 1;
    sim_colorcomponent_specular = 2;
    sim_colorcomponent_emission = 3;
    sim_colorcomponent_transparency = 4;
    sim_colorcomponent_auxiliary = 5;
    sim_volume_pyramid = 0;
    sim_volume_cylinder = 1;
    sim_volume_disc = 2;
    sim_volume_cone = 3;
    sim_volume_ray = 4;
    sim_volume_randomizedray = 5;
    sim_objintparam_visibility_layer = 10;
    sim_objfloatparam_abs_x_velocity = 11;
    sim_objfloatparam_abs_y_velocity = 12;
    sim_objfloatparam_abs_z_velocity = 13;
    sim_objfloatparam_abs_rot_velocity = 14;
    sim_objfloatparam_objbbox_min_x = 15;
    sim_objfloatparam_objbbox_min_y = 16;
    sim_objfloatparam_objbbox_min_z = 17;
    sim_objfloatparam_objbbox_max_x = 18;
    sim_objfloatparam_objbbox_max_y = 19;
    sim_objfloatparam_objbbox_max_z = 20;
    sim_objfloatparam_modelbbox_min_x = 21;
    sim_objfloatparam_modelbbox_min_y = 22;
    sim_objfloatparam_modelbbox_min_z = 23;
    sim_objfloatparam_modelbbox_max_x = 24;
    sim_objfloatparam_modelbbox_max_y = 25;
    sim_objfloatparam_modelbbox_max_z = 26;
    sim_objintparam_collection_self_collision_indicator = 27;
    sim_objfloatparam_transparency_offset = 28;
    sim_objintparam_child_role = 29;
    sim_objintparam_parent_role = 30;
    sim_objintparam_manipulation_permissions = 31;
    sim_objintparam_illumination_handle = 32;
    sim_objfloatparam_size_factor = 34;
    sim_visionfloatparam_near_clipping = 1000;
    sim_visionfloatparam_far_clipping = 1001;
    sim_visionintparam_resolution_x = 1002;
    sim_visionintparam_resolution_y = 1003;
    sim_visionfloatparam_perspective_angle = 1004;
    sim_visionfloatparam_ortho_size = 1005;
    sim_visionintparam_disabled_light_components = 1006;
    sim_visionintparam_rendering_attributes = 1007;
    sim_visionintparam_entity_to_render = 1008;
    sim_visionintparam_windowed_size_x = 1009;
    sim_visionintparam_windowed_size_y = 1010;
    sim_visionintparam_windowed_pos_x = 1011;
    sim_visionintparam_windowed_pos_y = 1012;
    sim_visionintparam_pov_focal_blur = 1013;
    sim_visionfloatparam_pov_blur_distance = 1014;
    sim_visionfloatparam_pov_aperture = 1015;
    sim_visionintparam_pov_blur_sampled = 1016;
    sim_visionintparam_render_mode = 1017;
    sim_jointfloatparam_pid_p = 2002;
    sim_jointfloatparam_pid_i = 2003;
    sim_jointfloatparam_pid_d = 2004;
    sim_jointfloatparam_intrinsic_x = 2005;
    sim_jointfloatparam_intrinsic_y = 2006;
    sim_jointfloatparam_intrinsic_z = 2007;
    sim_jointfloatparam_intrinsic_qx = 2008;
    sim_jointfloatparam_intrinsic_qy = 2009;
    sim_jointfloatparam_intrinsic_qz = 2010;
    sim_jointfloatparam_intrinsic_qw = 2011;
    sim_jointfloatparam_spherical_qx = 2013;
    sim_jointfloatparam_spherical_qy = 2014;
    sim_jointfloatparam_spherical_qz = 2015;
    sim_jointfloatparam_spherical_qw = 2016;
    sim_jointfloatparam_upper_limit = 2017;
    sim_jointfloatparam_kc_k = 2018;
    sim_jointfloatparam_kc_c = 2019;
    sim_jointfloatparam_ik_weight = 2021;
    sim_jointfloatparam_error_x = 2022;
    sim_jointfloatparam_error_y = 2023;
    sim_jointfloatparam_error_z = 2024;
    sim_jointfloatparam_error_a = 2025;
    sim_jointfloatparam_error_b = 2026;
    sim_jointfloatparam_error_g = 2027;
    sim_jointfloatparam_error_pos = 2028;
    sim_jointfloatparam_error_angle = 2029;
    sim_jointintparam_velocity_lock = 2030;
    sim_jointintparam_vortex_dep_handle = 2031;
    sim_jointfloatparam_vortex_dep_multiplication = 2032;
    sim_jointfloatparam_vortex_dep_offset = 2033;
    sim_shapefloatparam_init_velocity_x = 3000;
    sim_shapefloatparam_init_velocity_y = 3001;
    sim_shapefloatparam_init_velocity_z = 3002;
    sim_shapeintparam_static = 3003;
    sim_shapeintparam_respondable = 3004;
    sim_shapefloatparam_texture_x = 3006;
    sim_shapefloatparam_texture_y = 3007;
    sim_shapefloatparam_texture_z = 3008;
    sim_shapefloatparam_texture_a = 3009;
    sim_shapefloatparam_texture_b = 3010;
    sim_shapefloatparam_texture_g = 3011;
    sim_shapefloatparam_texture_scaling_x = 3012;
    sim_shapefloatparam_texture_scaling_y = 3013;
    sim_shapeintparam_culling = 3014;
    sim_shapeintparam_wireframe = 3015;
    sim_shapeintparam_compound = 3016;
    sim_shapeintparam_convex = 3017;
    sim_shapeintparam_convex_check = 3018;
    sim_shapeintparam_respondable_mask = 3019;
    sim_shapefloatparam_init_velocity_a = 3020;
    sim_shapefloatparam_init_velocity_b = 3021;
    sim_shapefloatparam_init_velocity_g = 3022;
    sim_shapeintparam_edge_visibility = 3024;
    sim_shapefloatparam_shading_angle = 3025;
    sim_shapefloatparam_edge_angle = 3026;
    sim_shapeintparam_edge_borders_hidden = 3027;
    sim_proxintparam_ray_invisibility = 4000;
    sim_proxintparam_volume_type = 4001;
    sim_proxintparam_entity_to_detect = 4002;
    sim_forcefloatparam_error_x = 5000;
    sim_forcefloatparam_error_y = 5001;
    sim_forcefloatparam_error_z = 5002;
    sim_forcefloatparam_error_a = 5003;
    sim_forcefloatparam_error_b = 5004;
    sim_forcefloatparam_error_g = 5005;
    sim_forcefloatparam_error_pos = 5006;
    sim_forcefloatparam_error_angle = 5007;
    sim_cameraintparam_disabled_light_components = 9000;
    sim_camerafloatparam_perspective_angle = 9001;
    sim_camerafloatparam_ortho_size = 9002;
    sim_cameraintparam_rendering_attributes = 9003;
    sim_cameraintparam_pov_focal_blur = 9004;
    sim_camerafloatparam_pov_blur_distance = 9005;
    sim_camerafloatparam_pov_aperture = 9006;
    sim_cameraintparam_pov_blur_samples = 9007;
    sim_dummyintparam_link_type = 10000;
    sim_dummyintparam_follow_path = 10001;
    sim_dummyfloatparam_follow_path_offset = 10002;
    sim_filtercomponent_originalimage = 1;
    sim_filtercomponent_originaldepth = 2;
    sim_filtercomponent_uniformimage = 3;
    sim_filtercomponent_tooutput = 4;
    sim_filtercomponent_tobuffer1 = 5;
    sim_filtercomponent_tobuffer2 = 6;
    sim_filtercomponent_frombuffer1 = 7;
    sim_filtercomponent_frombuffer2 = 8;
    sim_filtercomponent_swapbuffers = 9;
    sim_filtercomponent_addbuffer1 = 10;
    sim_filtercomponent_subtractbuffer1 = 11;
    sim_filtercomponent_multiplywithbuffer1 = 12;
    sim_filtercomponent_horizontalflip = 13;
    sim_filtercomponent_verticalflip = 14;
    sim_filtercomponent_rotate = 15;
    sim_filtercomponent_shift = 16;
    sim_filtercomponent_resize = 17;
    sim_filtercomponent_3x3filter = 18;
    sim_filtercomponent_5x5filter = 19;
    sim_filtercomponent_sharpen = 20;
    sim_filtercomponent_edge = 21;
    sim_filtercomponent_rectangularcut = 22;
    sim_filtercomponent_circularcut = 23;
    sim_filtercomponent_normalize = 24;
    sim_filtercomponent_intensityscale = 25;
    sim_filtercomponent_keeporremovecolors = 26;
    sim_filtercomponent_scaleandoffsetcolors = 27;
    sim_filtercomponent_binary = 28;
    sim_filtercomponent_swapwithbuffer1 = 29;
    sim_filtercomponent_addtobuffer1 = 30;
    sim_filtercomponent_subtractfrombuffer1 = 31;
    sim_filtercomponent_correlationwithbuffer1 = 32;
    sim_filtercomponent_colorsegmentation = 33;
    sim_filtercomponent_blobextraction = 34;
    sim_filtercomponent_imagetocoord = 35;
    sim_filtercomponent_pixelchange = 36;
    sim_filtercomponent_velodyne = 37;
    sim_filtercomponent_todepthoutput = 38;
    sim_filtercomponent_customized = 1000;
    sim_buffer_uint8 = 0;
    sim_buffer_int8 = 1;
    sim_buffer_uint16 = 2;
    sim_buffer_int16 = 3;
    sim_buffer_uint32 = 4;
    sim_buffer_int32 = 5;
    sim_buffer_float = 6;
    sim_buffer_double = 7;
    sim_buffer_uint8rgb = 8;
    sim_buffer_uint8bgr = 9;
    sim_buffer_uint8rgba = 10;
    sim_buffer_uint8argb = 11;
    sim_buffer_base64 = 12;
    sim_buffer_split = 13;
    sim_dynmat_default = 2310013;
    sim_dynmat_highfriction = 2310014;
    sim_dynmat_lowfriction = 2310015;
    sim_dynmat_nofriction = 2310016;
    sim_dynmat_reststackgrasp = 2310017;
    sim_dynmat_foot = 2310018;
    sim_dynmat_wheel = 2310019;
    sim_dynmat_gripper = 2310020;
    sim_dynmat_floor = 2310021;
    sim_message_eventcallback_lastinstancepass = 336;
    sim_message_eventcallback_uipass = 337;
    sim_scripttype_jointctrlcallback_old = 4;
    sim_scripttype_contactcallback_old = 5;
    sim_scripttype_generalcallback_old = 7;
    sim_intparam_job_count = 38;
    sim_intparam_program_full_version = 39;
    sim_stringparam_machine_id = 119;
    sim_stringparam_machine_id_legacy = 120;
    sim_visionintparam_perspective_operation = 1018;
    sim_shapefloatparam_init_ang_velocity_x = 3020;
    sim_shapefloatparam_init_ang_velocity_y = 3021;
    sim_shapefloatparam_init_ang_velocity_z = 3022;
    sim_buffer_clamp = 256;
    sim_boolparam_xr_partrepository = 50;
    sim_boolparam_xr_palletrepository = 51;
    sim_boolparam_xr_jobfunc = 55;
    sim_filtercomponent_originalimage_deprecated = 1;
    sim_filtercomponent_originaldepth_deprecated = 2;
    sim_filtercomponent_uniformimage_deprecated = 3;
    sim_filtercomponent_tooutput_deprecated = 4;
    sim_filtercomponent_tobuffer1_deprecated = 5;
    sim_filtercomponent_tobuffer2_deprecated = 6;
    sim_filtercomponent_frombuffer1_deprecated = 7;
    sim_filtercomponent_frombuffer2_deprecated = 8;
    sim_filtercomponent_swapbuffers_deprecated = 9;
    sim_filtercomponent_addbuffer1_deprecated = 10;
    sim_filtercomponent_subtractbuffer1_deprecated = 11;
    sim_filtercomponent_multiplywithbuffer1_deprecated = 12;
    sim_filtercomponent_horizontalflip_deprecated = 13;
    sim_filtercomponent_verticalflip_deprecated = 14;
    sim_filtercomponent_rotate_deprecated = 15;
    sim_filtercomponent_shift_deprecated = 16;
    sim_filtercomponent_resize_deprecated = 17;
    sim_filtercomponent_3x3filter_deprecated = 18;
    sim_filtercomponent_5x5filter_deprecated = 19;
    sim_filtercomponent_sharpen_deprecated = 20;
    sim_filtercomponent_edge_deprecated = 21;
    sim_filtercomponent_rectangularcut_deprecated = 22;
    sim_filtercomponent_circularcut_deprecated = 23;
    sim_filtercomponent_normalize_deprecated = 24;
    sim_filtercomponent_intensityscale_deprecated = 25;
    sim_filtercomponent_keeporremovecolors_deprecated = 26;
    sim_filtercomponent_scaleandoffsetcolors_deprecated = 27;
    sim_filtercomponent_binary_deprecated = 28;
    sim_filtercomponent_swapwithbuffer1_deprecated = 29;
    sim_filtercomponent_addtobuffer1_deprecated = 30;
    sim_filtercomponent_subtractfrombuffer1_deprecated = 31;
    sim_filtercomponent_correlationwithbuffer1_deprecated = 32;
    sim_filtercomponent_colorsegmentation_deprecated = 33;
    sim_filtercomponent_blobextraction_deprecated = 34;
    sim_filtercomponent_imagetocoord_deprecated = 35;
    sim_filtercomponent_pixelchange_deprecated = 36;
    sim_filtercomponent_velodyne_deprecated = 37;
    sim_filtercomponent_todepthoutput_deprecated = 38;
    sim_filtercomponent_customized_deprecated = 1000;
    sim_appobj_constraintsolver_type_old = 114;
    sim_appobj_motionplanning_type_old = 121;
    sim_ik_undamped_pseudo_inverse_method = 3;
    sim_ik_avoidance_constraint_old = 64;
    sim_objectspecialproperty_cuttable_old = 1024;
    sim_modelproperty_not_cuttable_old = 16;
    sim_message_eventcallback_scriptstatedestroyed = 338;
    sim_message_eventcallback_scriptdestroyed = 339;
    sim_displayattribute_groupselection_old = 16;
    sim_objectproperty_hierarchyhiddenmodelchild = 32768;
    sim_drawing_linestrip = 8;
    sim_boolparam_threaded_rendering_enabled_old = 32;
    sim_intparam_event_flags_read_old = 17;
    sim_intparam_event_flags_read_clear_old = 18;
    sim_intparam_verbosity = 40;
    sim_intparam_statusbarverbosity = 41;
    sim_intparam_dlgverbosity = 42;
    sim_intparam_videoencoder_index = 43;
    sim_intparam_exitcode = 44;
    sim_intparam_bugfix1 = 45;
    sim_stringparam_additional_addonscript1 = 11;
    sim_stringparam_additional_addonscript2 = 12;
    sim_stringparam_verbosity = 121;
    sim_stringparam_statusbarverbosity = 122;
    sim_stringparam_dlgverbosity = 123;
    sim_stringparam_consolelogfilter = 124;
    sim_stringparam_startupscriptstring = 125;
    sim_stringparam_uniqueid = 126;
    sim_jointmode_ik_deprecated = 2;
    sim_jointmode_hybrid_deprecated = 32;
    sim_verbosity_useglobal = -1;
    sim_verbosity_none = 100;
    sim_verbosity_errors = 200;
    sim_verbosity_warnings = 300;
    sim_verbosity_loadinfos = 400;
    sim_verbosity_questions = 410;
    sim_verbosity_scripterrors = 420;
    sim_verbosity_scriptwarnings = 430;
    sim_verbosity_scriptinfos = 450;
    sim_verbosity_msgs = 450;
    sim_verbosity_infos = 500;
    sim_verbosity_debug = 600;
    sim_verbosity_trace = 700;
    sim_verbosity_tracelua = 800;
    sim_verbosity_traceall = 900;
    sim_verbosity_default = 400;
    sim_verbosity_undecorated = 61440;
    sim_navigation_camerafly_old = 6;
    sim_objintparam_visible = 36;
    sim_jointfloatparam_screw_pitch = 2034;
    sim_jointfloatparam_step_size = 2035;
    sim_shapeintparam_component_cnt = 3028;
    sim_camerafloatparam_near_clipping = 9008;
    sim_camerafloatparam_far_clipping = 9009;
    sim_dummyfloatparam_size = 10003;
    sim_objectspecialproperty_detectable = 496;
    sim_message_eventcallback_simulationinit = 340;
    sim_message_eventcallback_simulationactuation = 341;
    sim_message_eventcallback_simulationsensing = 342;
    sim_message_eventcallback_simulationcleanup = 343;
    sim_objectproperty_ignoreviewfitting = 1;
    sim_handle_inverse = -14;
    sim_drawing_spherepts = 7;
    sim_drawing_trianglepts = 9;
    sim_drawing_quadpts = 10;
    sim_drawing_discpts = 11;
    sim_drawing_cubepts = 12;
    sim_boolparam_rayvalid = 56;
    sim_intparam_mouseclickcounterdown = 46;
    sim_intparam_mouseclickcounterup = 47;
    sim_stringparam_tempdir = 127;
    sim_stringparam_tempscenedir = 128;
    sim_stringparam_datadir = 129;
    sim_stringparam_importexportdir = 130;
    sim_stringparam_addonpath = 131;
    sim_stringparam_scenedefaultdir = 132;
    sim_stringparam_modeldefaultdir = 133;
    sim_stringparam_defaultpython = 134;
    sim_stringparam_additionalpythonpath = 135;
    sim_stringparam_luadir = 136;
    sim_stringparam_pythondir = 137;
    sim_arrayparam_rayorigin = 7;
    sim_arrayparam_raydirection = 8;
    sim_jointmode_kinematic = 0;
    sim_jointmode_dynamic = 5;
    sim_jointdynctrl_free = 0;
    sim_jointdynctrl_force = 1;
    sim_jointdynctrl_velocity = 4;
    sim_jointdynctrl_position = 8;
    sim_jointdynctrl_positioncb = 9;
    sim_jointdynctrl_spring = 12;
    sim_jointdynctrl_springcb = 13;
    sim_jointdynctrl_callback = 16;
    sim_physics_mujoco = 4;
    sim_primitiveshape_none = 0;
    sim_primitiveshape_plane = 1;
    sim_primitiveshape_disc = 2;
    sim_primitiveshape_cuboid = 3;
    sim_primitiveshape_spheroid = 4;
    sim_primitiveshape_cylinder = 5;
    sim_primitiveshape_cone = 6;
    sim_primitiveshape_heightfield = 7;
    sim_primitiveshape_capsule = 8;
    sim_objintparam_unique_id = 37;
    sim_jointfloatparam_maxvel = 2036;
    sim_jointfloatparam_maxaccel = 2037;
    sim_jointfloatparam_maxjerk = 2038;
    sim_jointintparam_dynctrlmode = 2039;
    sim_jointintparam_dynvelctrltype = 2040;
    sim_jointintparam_dynposctrltype = 2041;
    sim_shapeintparam_sleepmodestart = 3029;
    sim_cameraintparam_perspective_operation = 9010;
    sim_cameraintparam_trackedobject = 9011;
    sim_cameraintparam_remotecameramode = 9012;
    sim_message_eventcallback_moduleentry = 344;
    sim_drawing_local = 8388608;
    sim_intparam_objectcreationcounter = 48;
    sim_intparam_objectdestructioncounter = 49;
    sim_intparam_hierarchychangecounter = 50;
    sim_floatparam_physicstimestep = 5;
    sim_floatparam_maxtrisizeabs = 6;
    sim_floatparam_mintrisizerel = 7;
    sim_stringparam_mujocodir = 138;
    sim_stringparam_usersettingsdir = 139;
    sim_stringparam_systemdir = 140;
    sim_stringparam_resourcesdir = 141;
    sim_verbosity_onlyterminal = 65536;
    sim_physics_physx = 5;
    sim_jointfloatparam_screwlead = 2042;
    sim_shapeintparam_kinematic = 3030;
    sim_shapeintparam_respondablesuspendcnt = 3031;
    sim_message_eventcallback_events = 345;
    sim_objectproperty_hiddenforsimulation = 65536;
    sim_boolparam_qglwidget = 57;
    sim_boolparam_execunsafe = 58;
    sim_boolparam_execunsafeext = 59;
    sim_boolparam_cansave = 60;
    sim_stringparam_legacymachinetag = 142;
    sim_stringparam_addondir = 143;
    sim_stringparam_sandboxlang = 144;
    sim_objintparam_hierarchycolor = 38;
    sim_visionintparam_rgbignored = 1020;
    sim_visionintparam_depthignored = 1021;
    sim_dummyintparam_dummytype = 10000;
    sim_object_script_type = 17;
    sim_message_eventcallback_scriptstateabouttobedestroyed = 338;
    sim_message_eventcallback_scriptabouttobedestroyed = 339;
    sim_scripttype_main = 0;
    sim_scripttype_simulation = 1;
    sim_scripttype_addon = 2;
    sim_scripttype_customization = 6;
    sim_scripttype_sandbox = 8;
    sim_scripttype_passive = 9;
    sim_handle_appstorage = -15;
    sim_boolparam_usingscriptobjects = 61;
    sim_intparam_notifydeprecated = 51;
    sim_intparam_processid = 52;
    sim_intparam_processcnt = 53;
    sim_verbosity_once = 131072;
    sim_light_omnidirectional = 1;
    sim_light_spot = 2;
    sim_light_directional = 3;
    sim_joint_revolute = 10;
    sim_joint_prismatic = 11;
    sim_joint_spherical = 12;
    sim_proximitysensor_pyramid = 30;
    sim_proximitysensor_cylinder = 31;
    sim_proximitysensor_disc = 32;
    sim_proximitysensor_cone = 33;
    sim_proximitysensor_ray = 34;
    sim_handle_mainscript = -5;
    sim_handle_sceneobject = -16;
    sim_handle_sandbox = -17;
    sim_handle_mesh = -18;
    sim_physics_drake = 5;
  end

  methods
    function api = remApi(varargin)
      % The name of a library and of a header may be given; none is needed.
    end

    function delete(api)
      % Connections outlive the object, as in the original: programs make one in every function.
    end

    % ---- connection and simulation

    function id = simxStart(api, address, port, wait, once, timeout_ms, cycle_ms)
      id = -1;
      known = links();
      for tries = 1:(1 + 1e6 * double(wait && ~once))
        try
          link = simxLink(address, port, max(1, abs(timeout_ms) / 1000));
          id = known.Count;
          while isKey(known, id), id = id + 1; end
          known(id) = link;
          return
        catch
          if wait && ~once, pause(0.2); end
        end
      end
    end

    function simxFinish(api, id)
      known = links();
      if id == -1, ids = cell2mat(keys(known)); else, ids = id; end
      for k = ids
        if isKey(known, k)
          link = known(k);
          remove(known, k);
          link.disconnect();
        end
      end
    end

    function code = simxGetConnectionId(api, id)
      code = double(isKey(links(), id)) - 1;
    end

    function code = simxSynchronous(api, id, enable)
      code = ask(id, 2 - double(logical(enable)), [], [], api.simx_opmode_blocking);
      if code == 0
        link = find_link(id);
        link.is_synchronous = logical(enable);
      end
    end

    function code = simxSynchronousTrigger(api, id)
      code = ask(id, 3, [], [], api.simx_opmode_blocking);
    end

    function code = simxStartSimulation(api, id, mode)
      code = ask(id, 4103, i32(0), [], mode);
    end

    function code = simxPauseSimulation(api, id, mode)
      code = ask(id, 4103, i32(1), [], mode);
    end

    function code = simxStopSimulation(api, id, mode)
      code = ask(id, 4103, i32(2), [], mode);
    end

    function [code, ms] = simxGetPingTime(api, id)
      start = tic;
      code = ask(id, 4129, i32(1), [], api.simx_opmode_blocking);
      ms = round(1000 * toc(start));
    end

    function ms = simxGetLastCmdTime(api, id)
      link = find_link(id);
      if isempty(link), ms = 0; else, ms = link.command_time; end
    end

    function code = simxPauseCommunication(api, id, hold)
      link = find_link(id);
      if isempty(link), code = 64; return, end
      code = 0;
      link.is_held = logical(hold);
      if ~link.is_held, link.exchange(); end
    end

    function [code, errors] = simxGetLastErrors(api, id, mode)
      [code, data] = ask(id, 4, [], [], mode);
      errors = cell(0, 1);
      if numel(data) > 4, errors = texts(data(5:end)).'; end
    end

    function code = simxLoadScene(api, id, path, options, mode)
      code = ask(id, 12290, text(path), [], mode);
    end

    function code = simxCloseScene(api, id, mode)
      code = ask(id, 5, [], [], mode);
    end

    function code = simxAddStatusbarMessage(api, id, message, mode)
      code = ask(id, 12296, text(message), [], mode);
    end

    function [code, ints, floats, strings, buffer] = simxCallScriptFunction(api, id, object, type, name, ints, floats, strings, buffer, mode)
      if ischar(strings) && ~isempty(strings), strings = {strings}; end
      packed = uint8([]);
      for k = 1:numel(strings), packed = [packed, text(strings{k})]; end
      data = [i32([numel(ints), numel(floats), numel(strings), numel(buffer)]), i32(ints), f32(floats), packed, uint8(buffer(:).')];
      [code, data] = ask(id, 13313, [i32(type), text(object), text(name)], data, mode);
      [ints, floats, strings, buffer] = deal([], [], {}, uint8([]));
      if isempty(data), return, end
      n = ints_of(data(1:16));
      ints = ints_of(data(16 + (1:4 * n(1))));
      floats = floats_of(data(16 + 4 * n(1) + (1:4 * n(2))));
      rest = data(16 + 4 * n(1) + 4 * n(2) + 1 : end);
      buffer = rest(end - n(4) + 1 : end);
      strings = texts(rest(1 : end - n(4)));
    end

    % ---- objects

    function [code, handle] = simxGetObjectHandle(api, id, name, mode)
      [code, handle] = whole(ask_for(id, 12289, text(name), mode), -1);
    end

    function [code, handles] = simxGetObjects(api, id, type, mode)
      [code, data] = ask(id, 4138, i32(type), [], mode);
      handles = [];
      if ~isempty(data), handles = ints_of(data(5:end)); end
    end

    function [code, p] = simxGetObjectPosition(api, id, handle, against, mode)
      [code, p] = real_list(ask_for(id, 8206, i32([handle, against]), mode), 3);
    end

    function [code, angles] = simxGetObjectOrientation(api, id, handle, against, mode)
      [code, angles] = real_list(ask_for(id, 8205, i32([handle, against]), mode), 3);
    end

    function [code, q] = simxGetObjectQuaternion(api, id, handle, against, mode)
      [code, q] = real_list(ask_for(id, 10241, i32([handle, against]), mode), 4);
    end

    function [code, v, w] = simxGetObjectVelocity(api, id, handle, mode)
      [code, both] = real_list(ask_for(id, 4150, i32(handle), mode), 6);
      v = both(1:3);  w = both(4:6);
    end

    function code = simxSetObjectPosition(api, id, handle, against, p, mode)
      code = ask(id, 4123, i32(handle), [i32(against), f32(p)], mode);
    end

    function code = simxSetObjectOrientation(api, id, handle, against, angles, mode)
      code = ask(id, 4122, i32(handle), [i32(against), f32(angles)], mode);
    end

    function code = simxSetObjectQuaternion(api, id, handle, against, q, mode)
      code = ask(id, 6145, i32(handle), [i32(against), f32(q)], mode);
    end

    function [code, parent] = simxGetObjectParent(api, id, handle, mode)
      [code, parent] = whole(ask_for(id, 4114, i32(handle), mode), -1);
    end

    function [code, child] = simxGetObjectChild(api, id, handle, index, mode)
      [code, child] = whole(ask_for(id, 8203, i32([handle, index]), mode), -1);
    end

    function code = simxSetObjectParent(api, id, handle, parent, keep, mode)
      code = ask(id, 4124, i32(handle), [i32(parent), uint8(logical(keep))], mode);
    end

    function [code, x] = simxGetObjectIntParameter(api, id, handle, parameter, mode)
      [code, x] = whole(ask_for(id, 8200, i32([handle, parameter]), mode), 0);
    end

    function code = simxSetObjectIntParameter(api, id, handle, parameter, x, mode)
      code = ask(id, 8202, i32([handle, parameter]), i32(x), mode);
    end

    function [code, x] = simxGetObjectFloatParameter(api, id, handle, parameter, mode)
      [code, x] = real_list(ask_for(id, 8199, i32([handle, parameter]), mode), 1);
    end

    function code = simxSetObjectFloatParameter(api, id, handle, parameter, x, mode)
      code = ask(id, 8201, i32([handle, parameter]), f32(x), mode);
    end

    function [code, handle] = simxCreateDummy(api, id, size, colors, mode)
      [code, data] = ask(id, 9, [], [f32(size), zeros(1, 13, 'uint8')], mode);
      [code, handle] = whole({code, data}, -1);
    end

    function code = simxRemoveObject(api, id, handle, mode)
      code = ask(id, 4136, i32(handle), [], mode);
    end

    % ---- joints

    function [code, x] = simxGetJointPosition(api, id, joint, mode)
      [code, x] = real_list(ask_for(id, 4097, i32(joint), mode), 1);
    end

    function code = simxSetJointPosition(api, id, joint, x, mode)
      code = ask(id, 4098, i32(joint), f32(x), mode);
    end

    function code = simxSetJointTargetVelocity(api, id, joint, v, mode)
      code = ask(id, 4104, i32(joint), f32(v), mode);
    end

    function code = simxSetJointTargetPosition(api, id, joint, x, mode)
      code = ask(id, 4108, i32(joint), f32(x), mode);
    end

    function [code, effort] = simxGetJointForce(api, id, joint, mode)
      [code, effort] = real_list(ask_for(id, 4109, i32(joint), mode), 1);
    end

    function [code, effort] = simxJointGetForce(api, id, joint, mode)
      [code, effort] = api.simxGetJointForce(id, joint, mode);
    end

    function [code, effort] = simxGetJointMaxForce(api, id, joint, mode)
      [code, effort] = real_list(ask_for(id, 4152, i32(joint), mode), 1);
    end

    function code = simxSetJointForce(api, id, joint, effort, mode)
      code = ask(id, 4110, i32(joint), f32(effort), mode);
    end

    function code = simxSetJointMaxForce(api, id, joint, effort, mode)
      code = api.simxSetJointForce(id, joint, effort, mode);
    end

    function [code, m] = simxGetJointMatrix(api, id, joint, mode)
      [code, m] = real_list(ask_for(id, 4106, i32(joint), mode), 12);
    end

    % ---- sensors

    function [code, state, force, torque] = simxReadForceSensor(api, id, sensor, mode)
      [code, data] = ask(id, 4111, i32(sensor), [], mode);
      [state, force, torque] = deal(0, zeros(1, 3), zeros(1, 3));
      if ~isempty(data)
        [state, force, torque] = deal(double(data(1)), floats_of(data(2:13)), floats_of(data(14:25)));
      end
    end

    function [code, state, point, object, normal] = simxReadProximitySensor(api, id, sensor, mode)
      [code, data] = ask(id, 4105, i32(sensor), [], mode);
      [state, point, object, normal] = deal(0, zeros(1, 3), -1, zeros(1, 3));
      if ~isempty(data)
        [state, point] = deal(double(data(1)), floats_of(data(2:13)));
        [object, normal] = deal(ints_of(data(14:17)), floats_of(data(18:29)));
      end
    end

    function [code, resolution, image] = simxGetVisionSensorImage2(api, id, sensor, grey, mode)
      [code, data] = ask(id, 4100 - double(logical(grey)), i32(sensor), [], mode);
      [resolution, image] = deal([0, 0], uint8([]));
      if isempty(data), return, end
      resolution = ints_of(data(1:8));
      n = 3 - 2 * double(logical(grey));
      % rows from the lowest one; as a picture of Octave: from the highest one, colours last
      image = permute(reshape(data(9:end), n, resolution(1), resolution(2)), [3, 2, 1]);
      image = image(end:-1:1, :, :);
    end

    function [code, resolution, depth] = simxGetVisionSensorDepthBuffer2(api, id, sensor, mode)
      [code, data] = ask(id, 4119, i32(sensor), [], mode);
      [resolution, depth] = deal([0, 0], []);
      if isempty(data), return, end
      resolution = ints_of(data(1:8));
      depth = reshape(floats_of(data(9:end)), resolution(1), resolution(2)).';
      depth = depth(end:-1:1, :);
    end

    function [code, hit] = simxCheckCollision(api, id, one, other, mode)
      [code, hit] = whole(ask_for(id, 8207, i32([one, other]), mode), 0);
    end

    function [code, distance] = simxCheckDistance(api, id, one, other, mode)
      [code, distance] = real_list(ask_for(id, 8208, i32([one, other]), mode), 1);
    end

    % ---- signals and parameters

    function [code, x] = simxGetFloatSignal(api, id, name, mode)
      [code, x] = real_list(ask_for(id, 12304, text(name), mode), 1);
    end

    function code = simxSetFloatSignal(api, id, name, x, mode)
      code = ask(id, 12307, text(name), f32(x), mode);
    end

    function code = simxClearFloatSignal(api, id, name, mode)
      code = ask(id, 12301, text(name), [], mode);
    end

    function [code, x] = simxGetIntegerSignal(api, id, name, mode)
      [code, x] = whole(ask_for(id, 12305, text(name), mode), 0);
    end

    function code = simxSetIntegerSignal(api, id, name, x, mode)
      code = ask(id, 12308, text(name), i32(x), mode);
    end

    function code = simxClearIntegerSignal(api, id, name, mode)
      code = ask(id, 12302, text(name), [], mode);
    end

    function [code, bytes] = simxGetStringSignal(api, id, name, mode)
      [code, bytes] = ask(id, 12306, text(name), [], mode);
      bytes = char(bytes);
    end

    function code = simxSetStringSignal(api, id, name, bytes, mode)
      code = ask(id, 12309, text(name), uint8(bytes(:).'), mode);
    end

    function code = simxClearStringSignal(api, id, name, mode)
      code = ask(id, 12303, text(name), [], mode);
    end

    function [code, x] = simxGetIntegerParameter(api, id, parameter, mode)
      [code, x] = whole(ask_for(id, 4129, i32(parameter), mode), 0);
    end

    function code = simxSetIntegerParameter(api, id, parameter, x, mode)
      code = ask(id, 4130, i32(parameter), i32(x), mode);
    end

    function [code, x] = simxGetFloatingParameter(api, id, parameter, mode)
      [code, x] = real_list(ask_for(id, 4131, i32(parameter), mode), 1);
    end

    function code = simxSetFloatingParameter(api, id, parameter, x, mode)
      code = ask(id, 4132, i32(parameter), f32(x), mode);
    end

    function [code, x] = simxGetBooleanParameter(api, id, parameter, mode)
      [code, x] = whole(ask_for(id, 4127, i32(parameter), mode), 0);
    end

    function code = simxSetBooleanParameter(api, id, parameter, x, mode)
      code = ask(id, 4128, i32(parameter), i32(double(logical(x))), mode);
    end

    function [code, x] = simxGetArrayParameter(api, id, parameter, mode)
      [code, x] = real_list(ask_for(id, 4125, i32(parameter), mode), 3);
    end

    function code = simxSetArrayParameter(api, id, parameter, x, mode)
      code = ask(id, 4126, i32(parameter), f32(x), mode);
    end

    function [code, x] = simxGetStringParameter(api, id, parameter, mode)
      [code, data] = ask(id, 4133, i32(parameter), [], mode);
      x = char(data(data ~= 0));
    end
  end
end

% ---- connections and bytes

function known = links()
  persistent all;
  if isempty(all)
    if exist('OCTAVE_VERSION', 'builtin'), pkg load instrument-control, end
    all = containers.Map('KeyType', 'double', 'ValueType', 'any');
  end
  known = all;
end

function link = find_link(id)
  known = links();
  link = [];
  if isKey(known, id), link = known(id); end
end

function [code, answer] = ask(id, command, ident, data, mode)
  answer = uint8([]);
  link = find_link(id);
  if isempty(link), code = 64; return, end
  [code, answer] = link.ask(command, uint8(ident), uint8(data), mode);
end

function both = ask_for(id, command, ident, mode)
  [code, data] = ask(id, command, ident, [], mode);
  both = {code, data};
end

function [code, x] = whole(answer, none)
  [code, x] = deal(answer{1}, none);
  if numel(answer{2}) >= 4, x = ints_of(answer{2}(1:4)); end
end

function [code, x] = real_list(answer, n)
  [code, x] = deal(answer{1}, zeros(1, n));
  if numel(answer{2}) >= 4 * n, x = floats_of(answer{2}(1:4 * n)); end
end

function b = i32(x)
  b = typecast(int32(reshape(x, 1, [])), 'uint8');
end

function b = f32(x)
  b = typecast(single(reshape(x, 1, [])), 'uint8');
end

function b = text(characters)
  b = [uint8(characters), uint8(0)];
end

function x = ints_of(data)
  x = double(typecast(data, 'int32'));
end

function x = floats_of(data)
  x = double(typecast(data, 'single'));
end

function list = texts(data)
  ends = find(data == 0);
  starts = [1, ends(1:end - 1) + 1];
  list = arrayfun(@(a, b) char(data(a:b - 1)), starts, ends, 'UniformOutput', false);
end
